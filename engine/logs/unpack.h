#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace surefield {

/// How the bytes of a chunk of a log are stored.
enum class Packing { None, Lz4, Zstd, Bz2 };

/// The packing by the name that logs give it: "" or "none", "lz4", "zstd", "bz2"; nullopt for any other.
std::optional<Packing> packing_of(std::string_view name);

/// More bytes than any chunk of a log is unpacked to.
inline constexpr uint64_t kLargestChunk = uint64_t{512} << 20;

/// Unpacks what becomes `size` bytes. The memory that is taken grows with what comes out, since a damaged
/// file may promise anything. Throws InputError, naming `name`, where the bytes are damaged, become another
/// number of bytes, or more than kLargestChunk.
std::string unpack(std::string_view packed, Packing packing, uint64_t size,
                   const std::filesystem::path& name);

/// Whether the bytes begin as a zstd frame.
bool is_zstd(std::string_view bytes);

/// Unpacks a message that was packed by itself with zstd, as `ros2 bag record --compression-mode message`
/// does. Throws InputError as unpack() does, and where the frame does not say its size.
std::string unpack_zstd_message(std::string_view packed, const std::filesystem::path& name);

}  // namespace surefield
