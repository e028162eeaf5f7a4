// Cameras in JSON.
#include "engine/io/camera_json.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("camera.json", surefield::read_camera)
