// Trajectories in JSON.
#include "engine/io/trajectory_formats.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("transforms.json", surefield::read_any_trajectory)
