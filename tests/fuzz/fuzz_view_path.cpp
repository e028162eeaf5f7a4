// Camera paths of films.
#include "engine/viewer/view_path.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("path.json", surefield::read_view_path)
