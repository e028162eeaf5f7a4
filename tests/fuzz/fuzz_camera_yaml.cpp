// Cameras of own recordings.
#include "engine/sources/camera_file.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("camera.yaml", surefield::read_camera_file)
