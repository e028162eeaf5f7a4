// Trajectories of any system, by their content.
#include "engine/io/trajectory_formats.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("trajectory.txt", surefield::read_any_trajectory)
