// Maps as PLY, compressed PLY among them.
#include "engine/formats/map_file.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("map.ply", surefield::read_map)
