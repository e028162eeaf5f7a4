// ROS 2's MCAP files: every message, and the recording in them.
#include "tests/fuzz/log_harness.h"

SUREFIELD_FUZZ_FILE("recording.mcap", surefield::fuzz::read_log)
