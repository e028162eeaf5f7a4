#include "engine/logs/unpack.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <span>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr uint64_t kFirstBuffer = 1 << 16;

struct Progress {
  std::size_t consumed = 0;
  std::size_t produced = 0;
};

[[noreturn]] void refuse_packed(const std::filesystem::path& name, const char* what) {
  throw InputError(name, std::string("is damaged: what it packs with ") + what + " cannot be unpacked");
}

/// Calls `step(in, out)` until it neither consumes nor produces; gives it more room as it needs it.
template <typename Step>
std::string unpack_growing(std::string_view packed, uint64_t size, const std::filesystem::path& name,
                           Step step) {
  std::string out(std::min<uint64_t>(size, std::max<uint64_t>(kFirstBuffer, 4 * packed.size())), '\0');
  std::size_t written = 0;
  while (true) {
    const Progress made = step(packed, std::span<char>(out.data() + written, out.size() - written));
    packed.remove_prefix(made.consumed);
    written += made.produced;
    if (written == out.size() && out.size() < size) {
      out.resize(std::min<uint64_t>(size, 2 * out.size()));
    } else if (made.consumed == 0 && made.produced == 0) {
      break;
    }
  }
  if (written != size)
    throw InputError(name, fmt::format("is damaged: {} bytes where it promises {}", written, size));
  return out;
}

std::string unpack_lz4(std::string_view packed, uint64_t size, const std::filesystem::path& name) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(
      context, &LZ4F_freeDecompressionContext);
  return unpack_growing(packed, size, name, [&](std::string_view in, std::span<char> out) {
    std::size_t consumed = in.size(), produced = out.size();
    const std::size_t result = LZ4F_decompress(context, out.data(), &produced, in.data(), &consumed, nullptr);
    if (LZ4F_isError(result)) refuse_packed(name, "lz4");
    return Progress{consumed, produced};
  });
}

std::string unpack_zstd(std::string_view packed, uint64_t size, const std::filesystem::path& name) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          &ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  return unpack_growing(packed, size, name, [&](std::string_view in, std::span<char> out) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out.data(), out.size(), 0};
    if (ZSTD_isError(ZSTD_decompressStream(stream.get(), &output, &input))) refuse_packed(name, "zstd");
    return Progress{input.pos, output.pos};
  });
}

std::string unpack_bz2(std::string_view packed, uint64_t size, const std::filesystem::path& name) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> owner(&stream, &BZ2_bzDecompressEnd);
  bool ended = false;
  return unpack_growing(packed, size, name, [&](std::string_view in, std::span<char> out) {
    if (ended) return Progress{};
    stream.next_in = const_cast<char*>(in.data());  // it is only read
    stream.avail_in = static_cast<unsigned>(in.size());
    stream.next_out = out.data();
    stream.avail_out = static_cast<unsigned>(out.size());
    const int result = BZ2_bzDecompress(&stream);
    if (result != BZ_OK && result != BZ_STREAM_END) refuse_packed(name, "bz2");
    ended = result == BZ_STREAM_END;
    return Progress{in.size() - stream.avail_in, out.size() - stream.avail_out};
  });
}

}  // namespace

std::optional<Packing> packing_of(std::string_view name) {
  if (name.empty() || name == "none") return Packing::None;
  if (name == "lz4") return Packing::Lz4;
  if (name == "zstd") return Packing::Zstd;
  if (name == "bz2") return Packing::Bz2;
  return std::nullopt;
}

std::string unpack(std::string_view packed, Packing packing, uint64_t size,
                   const std::filesystem::path& name) {
  if (size > kLargestChunk || packed.size() > kLargestChunk)
    throw InputError(name, "is damaged: a chunk would take more memory than any has");
  switch (packing) {
    case Packing::Lz4:
      return unpack_lz4(packed, size, name);
    case Packing::Zstd:
      return unpack_zstd(packed, size, name);
    case Packing::Bz2:
      return unpack_bz2(packed, size, name);
    default:
      if (packed.size() != size) throw InputError(name, "is damaged: a chunk has two sizes");
      return std::string(packed);
  }
}

bool is_zstd(std::string_view bytes) {
  return bytes.starts_with("\x28\xb5\x2f\xfd");
}

std::string unpack_zstd_message(std::string_view packed, const std::filesystem::path& name) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN) refuse_packed(name, "zstd");
  return unpack(packed, Packing::Zstd, size, name);
}

}  // namespace surefield
