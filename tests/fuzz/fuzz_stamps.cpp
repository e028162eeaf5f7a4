// Lists of time stamps.
#include "engine/io/trajectory_formats.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("times.txt", surefield::read_stamps)
