#pragma once

#include "engine/logs/byte_file.h"
#include "engine/logs/message_log.h"

namespace surefield {

/// Finds the messages of an MCAP file: by its summary and the indexes behind its chunks, or, where there is
/// no summary, or one that is damaged, by reading it from front to back as far as that goes. Throws
/// InputError where it does not begin as MCAP.
LogIndex index_mcap(const ByteFile& file);

}  // namespace surefield
