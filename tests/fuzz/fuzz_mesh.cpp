// Triangle meshes.
#include "engine/formats/triangle_mesh.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("mesh.ply", surefield::read_mesh)
