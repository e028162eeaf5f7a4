#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "engine/formats/ply_header.h"

namespace surefield {

/// The values of one record, property after property. A list takes as many values as it holds.
struct PlyRecord {
  std::vector<double> values;
  std::vector<std::size_t> starts;  ///< of each property in `values`, and the end of the last

  std::span<const double> property(std::size_t i) const {
    return std::span(values).subspan(starts[i], starts[i + 1] - starts[i]);
  }
};

/// Reads the records that follow a PLY header, one after another.
class PlyRecordReader {
 public:
  /// `file` and `header` must outlive the reader.
  PlyRecordReader(const std::filesystem::path& file, const PlyHeader& header);

  /// Reads the next record, which is one of `element`; the memory of `record` is reused. Throws InputError
  /// when the file ends before, or where no such record stands.
  void next(const PlyElement& element, PlyRecord& record);

 private:
  void next_binary(const PlyElement& element, PlyRecord& record);
  void next_ascii(const PlyElement& element, PlyRecord& record);
  double read_scalar(PlyType type);
  [[noreturn]] void fail(const PlyElement& element) const;

  const std::filesystem::path& file_;
  bool is_ascii_;
  std::ifstream stream_;
  std::uintmax_t left_ = 0;  ///< bytes of a binary file that have not been read
  std::string line_;
};

}  // namespace surefield
