#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "tools/data/download.h"

namespace surefield {

/// Unpacks an archive (tar, zip, with any usual compression) into `folder`, which is created. Entries that
/// lead out of the folder, by name or as links, pipes and devices are refused; so is an archive that grows to
/// more than `most_bytes`, or, where that is not given, than the disk has free or fifty times its own size
/// (64 MiB are always allowed). The folder itself may lie behind ".." or a link. Returns false when
/// `progress`, told the bytes of the archive, asked to stop. Throws InputError, also when the archive is
/// damaged or the folder cannot be written; what was unpacked by then stays.
bool unpack(const std::filesystem::path& archive, const std::filesystem::path& folder,
            const TransferProgress& progress, std::optional<uint64_t> most_bytes = std::nullopt);

}  // namespace surefield
