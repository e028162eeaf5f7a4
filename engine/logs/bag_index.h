#pragma once

#include "engine/logs/byte_file.h"
#include "engine/logs/message_log.h"

namespace surefield {

/// Finds the messages of a ROS 1 bag: by the index at its end, or, where there is none or it is damaged, by
/// reading it from front to back as far as that goes. Throws InputError where it is no bag of version 2.0, or
/// encrypted.
LogIndex index_bag(const ByteFile& file);

}  // namespace surefield
