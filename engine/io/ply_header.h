#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace surefield {

/// The scalar types of PLY files.
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Size in bytes.
std::size_t ply_type_size(PlyType type);

/// A named scalar of each vertex.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
};

/// The header of a PLY file whose first element is `vertex`. What follows that element is ignored.
struct PlyHeader {
  bool is_ascii = false;  ///< else binary little endian
  std::size_t vertices = 0;
  std::vector<PlyProperty> properties;
  std::size_t data_offset = 0;  ///< of the first vertex, bytes from the start of the file

  /// Bytes of one vertex in a binary file.
  std::size_t stride() const { return offset(properties.size()); }

  /// Bytes from the start of a vertex to its property `i` in a binary file.
  std::size_t offset(std::size_t i) const;
};

/// Reads a header and checks that the file is long enough for its vertices. Throws InputError.
PlyHeader read_ply_header(const std::filesystem::path& file);

}  // namespace surefield
