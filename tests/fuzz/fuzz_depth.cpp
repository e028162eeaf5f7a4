// Depth images.
#include "engine/io/images.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("depth.png", [](const auto& file) { surefield::read_depth(file, {}); })
