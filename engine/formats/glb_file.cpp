#include "engine/formats/glb_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/formats/rounded_values.h"
#include "engine/formats/turned_axes.h"
#include "engine/io/files.h"
#include "engine/types/error.h"

static_assert(std::endian::native == std::endian::little,
              "glTF files are written in the byte order of the machine");

namespace surefield {

namespace {

// Numbers that the format gives to types of values, to uses of arrays and to parts of the file.
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kVertices = 34962, kIndices = 34963;
constexpr uint32_t kGlbMagic = 0x46546c67, kGlbVersion = 2, kJsonPart = 0x4e4f534a, kBinaryPart = 0x004e4942;

/// The inverse of sRGB's transfer function.
double linear(double value) {
  value = std::clamp(value, 0.0, 1.0);
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

/// The parts' lengths are multiples of four.
void pad(std::string& bytes, char with) {
  bytes.resize((bytes.size() + 3) / 4 * 4, with);
}

void put(std::ostream& stream, std::initializer_list<uint32_t> values) {
  for (uint32_t value : values) stream.write(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace

GlbFile::GlbFile()
    : json_({{"asset", {{"version", "2.0"}, {"generator", "Surefield"}}},
             {"scene", 0},
             {"scenes", nlohmann::json::array({nlohmann::json::object()})}}) {}

int GlbFile::add(const void* data, std::size_t bytes, nlohmann::json accessor, int target) {
  const auto number = static_cast<int>(json_["accessors"].size());
  json_["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}, {"target", target}});
  accessor["bufferView"] = number;
  json_["accessors"].push_back(std::move(accessor));
  binary_.append(static_cast<const char*>(data), bytes);
  pad(binary_, '\0');
  return number;
}

int GlbFile::add_floats(const std::vector<float>& values, const std::string& type) {
  const std::size_t width = type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
  return add(values.data(), values.size() * sizeof(float),
             {{"componentType", kFloat}, {"count", values.size() / width}, {"type", type}}, kVertices);
}

int GlbFile::add_positions(const std::vector<Eigen::Vector3f>& positions) {
  const Eigen::Map<const Eigen::Array3f> signs(kTurnedAxes.data());
  std::vector<float> values;
  Eigen::Array3f low = positions.front().array() * signs, high = low;
  for (const Eigen::Vector3f& position : positions) {
    const Eigen::Array3f turned = position.array() * signs;
    low = low.min(turned);
    high = high.max(turned);
    values.insert(values.end(), turned.begin(), turned.end());
  }
  const int number = add_floats(values, "VEC3");
  json_["accessors"].back()["min"] = {low[0], low[1], low[2]};
  json_["accessors"].back()["max"] = {high[0], high[1], high[2]};
  return number;
}

int GlbFile::add_colours(const std::vector<std::array<float, 4>>& colours) {
  constexpr uint32_t kMost = std::numeric_limits<uint16_t>::max();
  std::vector<uint16_t> values;
  for (const auto& colour : colours) {
    for (std::size_t k = 0; k < 4; ++k)
      values.push_back(
          static_cast<uint16_t>(to_steps((k < 3 ? linear(colour[k]) : colour[k]) * kMost, kMost)));
  }
  const nlohmann::json accessor = {
      {"componentType", kUnsignedShort}, {"count", colours.size()}, {"type", "VEC4"}, {"normalized", true}};
  return add(values.data(), values.size() * sizeof(uint16_t), accessor, kVertices);
}

int GlbFile::add_indices(const std::vector<std::array<uint32_t, 3>>& triangles) {
  return add(triangles.data(), triangles.size() * sizeof(triangles[0]),
             {{"componentType", kUnsignedInt}, {"count", triangles.size() * 3}, {"type", "SCALAR"}},
             kIndices);
}

void GlbFile::use_extension(const std::string& name) {
  json_["extensionsUsed"].push_back(name);
}

void GlbFile::set_mesh(const std::string& name, nlohmann::json primitive) {
  json_["meshes"][0] = {{"name", name}, {"primitives", nlohmann::json::array({std::move(primitive)})}};
  json_["nodes"][0] = {{"name", name}, {"mesh", 0}};
  json_["scenes"][0]["nodes"][0] = 0;
}

void GlbFile::turn_mesh(const Eigen::Matrix3d& world_to_file) {
  const Eigen::Map<const Eigen::Array3f> signs(kTurnedAxes.data());
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = world_to_file * signs.cast<double>().matrix().asDiagonal();
  const Eigen::Matrix3d by_rows = world_to_file.transpose();  // Eigen stores columns, and so does glTF
  json_["nodes"][0]["matrix"] = std::vector<double>(matrix.data(), matrix.data() + 16);
  json_["nodes"][0]["extras"]["world_to_file"] = std::vector<double>(by_rows.data(), by_rows.data() + 9);
}

void GlbFile::set_material(nlohmann::json material) {
  json_["materials"][0] = std::move(material);
}

void GlbFile::write(const std::filesystem::path& file) {
  if (!binary_.empty()) json_["buffers"][0] = {{"byteLength", binary_.size()}};
  std::string text = json_.dump();
  pad(text, ' ');
  const std::size_t length =
      12 + 8 + text.size() + (binary_.empty() ? std::size_t{0} : 8 + binary_.size());  // with all headers
  if (length > std::numeric_limits<uint32_t>::max())
    throw InputError(file, "cannot be written: binary glTF holds at most 4 GiB; use the PLY or SPZ format");
  const auto size = [](const std::string& bytes) { return static_cast<uint32_t>(bytes.size()); };
  write_file(file, [&](std::ostream& stream) {
    put(stream, {kGlbMagic, kGlbVersion, static_cast<uint32_t>(length), size(text), kJsonPart});
    stream << text;
    if (binary_.empty()) return;
    put(stream, {size(binary_), kBinaryPart});
    stream << binary_;
  });
}

}  // namespace surefield
