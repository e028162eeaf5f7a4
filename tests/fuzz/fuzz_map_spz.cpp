// Maps as SPZ.
#include "engine/formats/map_file.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("map.spz", surefield::read_map)
