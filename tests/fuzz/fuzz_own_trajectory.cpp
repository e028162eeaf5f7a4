// Our own trajectories.
#include "engine/io/trajectory_file.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("trajectory.txt", surefield::read_trajectory)
