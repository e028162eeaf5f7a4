// Float images.
#include "engine/io/images.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("image.tiff", surefield::read_tiff)
