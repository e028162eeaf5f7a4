#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace surefield {

/// The scalar types of PLY files.
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Size in bytes.
std::size_t ply_type_size(PlyType type);

/// A named scalar, or a named list of them, in each record of an element.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> list_length;  ///< type of the number before the values of a list; none for a scalar
};

/// A kind of records, for example all vertices.
struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  /// Where in the properties `property` stands; nullopt where the element has none of that name.
  std::optional<std::size_t> find(const std::string& property) const;
};

/// The header of a PLY file whose first element is `vertex`, with scalar properties only; in compressed
/// clouds `chunk` stands before it.
struct PlyHeader {
  bool is_ascii = false;              ///< else binary little endian
  std::vector<PlyElement> elements;   ///< in the order of their records; at least one
  std::vector<std::string> comments;  ///< what stands behind the word
  std::size_t data_offset = 0;        ///< of the first record, bytes from the start of the file

  bool is_compressed() const { return elements.front().name == "chunk"; }
  const PlyElement& vertices() const { return elements[is_compressed() ? 1 : 0]; }
};

/// Reads a header and checks that the file is long enough for its records. Throws InputError.
PlyHeader read_ply_header(const std::filesystem::path& file);

}  // namespace surefield
