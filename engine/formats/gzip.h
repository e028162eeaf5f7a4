#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace surefield {

/// Compresses what it is given into one gzip stream. The same bytes give the same stream each time.
class GzipWriter {
 public:
  /// `out` must outlive the writer.
  explicit GzipWriter(std::ostream& out);
  ~GzipWriter();

  void write(const std::vector<uint8_t>& bytes);
  /// Ends the stream; call it once, after the last write().
  void finish();

 private:
  struct Stream;
  void deflate_all(const std::vector<uint8_t>& bytes, int flush);

  std::ostream& out_;
  std::unique_ptr<Stream> stream_;
};

/// Whether `bytes` may be the start of a gzip stream.
bool starts_as_gzip(const std::string& bytes);

/// Decompresses a gzip stream piece by piece.
class GzipReader {
 public:
  /// `file` is named in errors. `compressed` must outlive the reader.
  GzipReader(std::filesystem::path file, const std::string& compressed);
  ~GzipReader();

  /// The next `count` bytes. Throws InputError when the stream is damaged or ends before them.
  std::vector<uint8_t> read(std::size_t count);
  /// Skips the rest of the stream, which checks its checksum. Throws InputError when it is damaged.
  void finish();

  /// Checks, with the memory of one piece, that a stream holds from `fewest` to `most` bytes. Throws
  /// InputError where it does not, or is damaged.
  static void require_length(const std::filesystem::path& file, const std::string& compressed,
                             std::size_t fewest, std::size_t most);

  /// The most bytes that a stream of `compressed` bytes can hold, so that a damaged count is refused before
  /// memory is asked for.
  static std::size_t most_bytes(std::size_t compressed);

 private:
  struct Stream;
  std::size_t inflate_into(uint8_t* to, std::size_t count);

  std::filesystem::path file_;
  std::unique_ptr<Stream> stream_;
  bool ended_ = false;
};

}  // namespace surefield
