#include "engine/formats/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <utility>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr int kGzipWindow = MAX_WBITS + 16;   // 16 asks zlib for the header and the checksum of gzip
constexpr std::size_t kMostExpansion = 1032;  // deflate's best ratio
constexpr std::size_t kPiece = std::size_t{1} << 16;

}  // namespace

struct GzipWriter::Stream {
  z_stream z{};

  Stream() {
    if (deflateInit2(&z, Z_BEST_COMPRESSION, Z_DEFLATED, kGzipWindow, 8, Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
  }
  ~Stream() { deflateEnd(&z); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
};

GzipWriter::GzipWriter(std::ostream& out) : out_(out), stream_(std::make_unique<Stream>()) {}
GzipWriter::~GzipWriter() = default;

void GzipWriter::write(const std::vector<uint8_t>& bytes) {
  // zlib counts in 32 bits.
  for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto length = static_cast<std::ptrdiff_t>(std::min(kPiece, bytes.size() - at));
    deflate_all({first, first + length}, Z_NO_FLUSH);
  }
}

void GzipWriter::finish() {
  deflate_all({}, Z_FINISH);
}

void GzipWriter::deflate_all(const std::vector<uint8_t>& bytes, int flush) {
  std::array<Bytef, kPiece> piece;
  z_stream& z = stream_->z;
  z.next_in = const_cast<Bytef*>(bytes.data());  // zlib does not write there
  z.avail_in = static_cast<uInt>(bytes.size());
  do {
    z.next_out = piece.data();
    z.avail_out = static_cast<uInt>(piece.size());
    deflate(&z, flush);
    out_.write(reinterpret_cast<const char*>(piece.data()),
               static_cast<std::streamsize>(piece.size() - z.avail_out));
  } while (z.avail_out == 0);
}

bool starts_as_gzip(const std::string& bytes) {
  return bytes.starts_with("\x1f\x8b");
}

struct GzipReader::Stream {
  z_stream z{};

  Stream() {
    if (inflateInit2(&z, kGzipWindow) != Z_OK) throw std::bad_alloc();
  }
  ~Stream() { inflateEnd(&z); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  const std::string* compressed = nullptr;
  std::size_t fed = 0;  ///< bytes handed to zlib
};

GzipReader::GzipReader(std::filesystem::path file, const std::string& compressed)
    : file_(std::move(file)), stream_(std::make_unique<Stream>()) {
  stream_->compressed = &compressed;
}
GzipReader::~GzipReader() = default;

std::vector<uint8_t> GzipReader::read(std::size_t count) {
  std::vector<uint8_t> bytes(count);
  for (std::size_t got = 0; got < count;) {
    const std::size_t more = inflate_into(bytes.data() + got, count - got);
    if (more == 0) throw InputError(file_, "ends too early; copy or write it again");
    got += more;
  }
  return bytes;
}

void GzipReader::finish() {
  std::array<uint8_t, kPiece> ignored;
  while (inflate_into(ignored.data(), ignored.size()) > 0) {
  }
  if (!ended_) throw InputError(file_, "ends too early; copy or write it again");
}

/// Fills at most `count` bytes; 0 at the end of the stream or of the file.
std::size_t GzipReader::inflate_into(uint8_t* to, std::size_t count) {
  z_stream& z = stream_->z;
  const std::string& compressed = *stream_->compressed;
  const auto room = static_cast<uInt>(std::min(count, std::size_t{std::numeric_limits<int>::max()}));
  z.next_out = to;
  z.avail_out = room;
  while (!ended_ && z.avail_out == room) {
    if (z.avail_in == 0) {
      const std::size_t length = std::min(kPiece, compressed.size() - stream_->fed);
      if (length == 0) break;
      z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data() + stream_->fed));
      z.avail_in = static_cast<uInt>(length);
      stream_->fed += length;
    }
    const int result = inflate(&z, Z_NO_FLUSH);
    ended_ = result == Z_STREAM_END;
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)
      throw InputError(file_, "is damaged: its gzip data is wrong; copy or write it again");
  }
  return room - z.avail_out;
}

void GzipReader::require_length(const std::filesystem::path& file, const std::string& compressed,
                                std::size_t fewest, std::size_t most) {
  GzipReader reader(file, compressed);
  std::array<uint8_t, kPiece> ignored;
  std::size_t length = 0;
  for (std::size_t more = 1; more > 0; length += more) {
    more = reader.inflate_into(ignored.data(), ignored.size());
    if (length + more > most)
      throw InputError(file, "is damaged: it goes on far beyond what its header tells of");
  }
  if (length < fewest || !reader.ended_) throw InputError(file, "ends too early; copy or write it again");
}

std::size_t GzipReader::most_bytes(std::size_t compressed) {
  return compressed * kMostExpansion;
}

}  // namespace surefield
