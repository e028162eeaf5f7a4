// ROS 1's bags: every message, and the recording in them.
#include "tests/fuzz/log_harness.h"

SUREFIELD_FUZZ_FILE("recording.bag", surefield::fuzz::read_log)
