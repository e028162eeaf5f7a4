#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/error.h"
#include "engine/io/files.h"
#include "engine/io/ply.h"
#include "engine/io/ply_header.h"

static_assert(std::endian::native == std::endian::little,
              "PLY files are read in the byte order of the machine");

namespace surefield {

namespace {

template <typename T>
double load_as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

double load_scalar(PlyType type, const char* bytes) {
  switch (type) {
    case PlyType::int8:
      return load_as<int8_t>(bytes);
    case PlyType::uint8:
      return load_as<uint8_t>(bytes);
    case PlyType::int16:
      return load_as<int16_t>(bytes);
    case PlyType::uint16:
      return load_as<uint16_t>(bytes);
    case PlyType::int32:
      return load_as<int32_t>(bytes);
    case PlyType::uint32:
      return load_as<uint32_t>(bytes);
    case PlyType::float32:
      return load_as<float>(bytes);
    case PlyType::float64:
      return load_as<double>(bytes);
  }
  return 0;
}

/// Where in a vertex the values stand that a Gaussian needs, in the order of GaussianFields.
struct GaussianLayout {
  int sh_degree = 0;
  std::vector<std::size_t>
      columns;  ///< mean, log scale, rotation, opacity, then SH coefficient by coefficient
};

std::size_t column(const std::filesystem::path& file, const PlyHeader& header, const std::string& name) {
  for (std::size_t i = 0; i < header.properties.size(); ++i) {
    if (header.properties[i].name == name) return i;
  }
  throw InputError(file, "has no property " + name + "; is it a Gaussian splatting PLY?");
}

int infer_sh_degree(const std::filesystem::path& file, const PlyHeader& header) {
  int rest = 0;
  for (const PlyProperty& property : header.properties) rest += property.name.starts_with("f_rest_") ? 1 : 0;
  for (int degree = 0; degree <= 3; ++degree) {
    if (rest == 3 * (sh_coefficients(degree) - 1)) return degree;
  }
  throw InputError(file,
                   "has " + std::to_string(rest) + " properties f_rest_*; only 0, 9, 24 or 45 are possible");
}

GaussianLayout find_layout(const std::filesystem::path& file, const PlyHeader& header) {
  GaussianLayout layout;
  layout.sh_degree = infer_sh_degree(file, header);
  const auto add = [&](const std::string& name) { layout.columns.push_back(column(file, header, name)); };
  for (const char* name : {"x", "y", "z", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3",
                           "opacity", "f_dc_0", "f_dc_1", "f_dc_2"}) {
    add(name);
  }
  const int rest = sh_coefficients(layout.sh_degree) - 1;
  for (int k = 0; k < rest; ++k) {
    for (int channel = 0; channel < 3; ++channel) add("f_rest_" + std::to_string(channel * rest + k));
  }
  return layout;
}

/// Appends one Gaussian; false when one of its values cannot be used.
bool append(const std::vector<float>& values, GaussianCloud& cloud) {
  for (float value : values) {
    if (!std::isfinite(value)) return false;
  }
  const Eigen::Vector4f rotation(values[6], values[7], values[8], values[9]);
  if (rotation.isZero(0)) return false;
  cloud.means.emplace_back(values[0], values[1], values[2]);
  cloud.log_scales.emplace_back(values[3], values[4], values[5]);
  cloud.rotations.push_back(rotation);
  cloud.opacity_logits.push_back(values[10]);
  cloud.sh.insert(cloud.sh.end(), values.begin() + 11, values.end());
  return true;
}

/// Reads vertex after vertex; each call of next() fills one value per column of the layout.
class VertexReader {
 public:
  VertexReader(const std::filesystem::path& file, const PlyHeader& header, const GaussianLayout& layout)
      : file_(file), header_(header), layout_(layout), stream_(file, std::ios::binary) {
    stream_.seekg(static_cast<std::streamoff>(header.data_offset));
    bytes_.resize(header.stride());
    for (std::size_t i : layout.columns) offsets_.push_back(header.offset(i));
  }

  void next(std::vector<float>& values) {
    if (header_.is_ascii) {
      next_ascii(values);
    } else {
      next_binary(values);
    }
  }

 private:
  void next_binary(std::vector<float>& values) {
    if (!stream_.read(bytes_.data(), static_cast<std::streamsize>(bytes_.size()))) fail();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const PlyType type = header_.properties[layout_.columns[i]].type;
      values[i] = static_cast<float>(load_scalar(type, bytes_.data() + offsets_[i]));
    }
  }

  void next_ascii(std::vector<float>& values) {
    if (!std::getline(stream_, line_)) fail();
    const auto numbers = parse_numbers(line_);
    if (!numbers || numbers->size() != header_.properties.size()) fail();
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>((*numbers)[layout_.columns[i]]);
  }

  [[noreturn]] void fail() const {
    throw InputError(file_, "ends or is damaged before its last Gaussian; copy or write it again");
  }

  const std::filesystem::path& file_;
  const PlyHeader& header_;
  const GaussianLayout& layout_;
  std::ifstream stream_;
  std::vector<std::size_t> offsets_;  ///< of the layout's columns, in bytes
  std::vector<char> bytes_;
  std::string line_;
};

}  // namespace

PlyCloud read_ply(const std::filesystem::path& file) {
  const PlyHeader header = read_ply_header(file);
  const GaussianLayout layout = find_layout(file, header);
  PlyCloud result;
  result.cloud.sh_degree = layout.sh_degree;
  VertexReader reader(file, header, layout);
  std::vector<float> values(layout.columns.size());
  for (std::size_t i = 0; i < header.vertices; ++i) {
    reader.next(values);
    if (!append(values, result.cloud)) ++result.dropped;
  }
  return result;
}

}  // namespace surefield
