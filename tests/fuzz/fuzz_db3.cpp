// ROS 2's databases: every message, and the recording in them.
#include "tests/fuzz/log_harness.h"

SUREFIELD_FUZZ_FILE("recording.db3", surefield::fuzz::read_log)
