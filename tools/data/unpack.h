#pragma once

#include <filesystem>

#include "tools/data/download.h"

namespace surefield {

/// Unpacks an archive (tar, zip, with any usual compression) into `folder`, which is created. Entries that
/// lead out of the folder are refused. Returns false when `progress`, told the bytes of the archive, asked to
/// stop. Throws InputError when the archive is damaged or the folder cannot be written.
bool unpack(const std::filesystem::path& archive, const std::filesystem::path& folder,
            const TransferProgress& progress);

}  // namespace surefield
