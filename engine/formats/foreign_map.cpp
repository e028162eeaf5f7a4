#include "engine/formats/foreign_map.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string_view>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kLooked = std::size_t{1} << 16;  // bytes that are looked at, of each end of the file

constexpr const char* kConvert =
    "; convert it to PLY, with SuperSplat or \"npx @playcanvas/splat-transform IN OUT.ply\"";

constexpr const char* kNumpy =
    "holds NumPy arrays (as SplaTAM's params.npz), which are not read here; write a PLY with the program "
    "that "
    "made it (SplaTAM: scripts/export_ply.py)";

/// What is looked at of a file.
struct Sample {
  std::uintmax_t size = 0;
  std::string start, end;
  std::string extension;  ///< lower case

  bool mentions(std::string_view text) const {
    return start.find(text) != std::string::npos || end.find(text) != std::string::npos;
  }
};

Sample sample_of(const std::filesystem::path& file) {
  Sample sample;
  sample.extension = file.extension().string();
  std::transform(sample.extension.begin(), sample.extension.end(), sample.extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  sample.size = std::filesystem::file_size(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file, "cannot be opened; check its permissions");
  const auto length = static_cast<std::streamsize>(std::min<std::uintmax_t>(sample.size, kLooked));
  sample.start.resize(static_cast<std::size_t>(length));
  stream.read(sample.start.data(), length);
  sample.end.resize(static_cast<std::size_t>(length));
  stream.seekg(-length, std::ios::end);
  stream.read(sample.end.data(), length);
  return sample;
}

template <typename T>
T value_at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

/// The header of mkkellogg's .ksplat, which has no magic number: version 0.1, sections and splats of at most
/// as many as there is room for, one of three levels of compression.
bool is_ksplat(const Sample& sample) {
  constexpr std::size_t kHeader = 4096, kSectionHeader = 1024;
  if (sample.start.size() < kHeader || sample.start[0] != 0 || sample.start[1] != 1) return false;
  const auto most_sections = value_at<uint32_t>(sample.start, 4),
             sections = value_at<uint32_t>(sample.start, 8);
  const auto most_splats = value_at<uint32_t>(sample.start, 12),
             splats = value_at<uint32_t>(sample.start, 16);
  return sections > 0 && sections <= most_sections && splats > 0 && splats <= most_splats &&
         value_at<uint16_t>(sample.start, 20) <= 2 && sample.size >= kHeader + most_sections * kSectionHeader;
}

/// Antimatter's .splat, which has no header: places and sizes as floats, colour and rotation in bytes.
bool is_splat(const Sample& sample) {
  constexpr std::size_t kRecord = 32;
  constexpr float kFarthest = 1e6f, kLargest = 1e5f;  // metres
  if (sample.size == 0 || sample.size % kRecord != 0) return false;
  for (std::size_t at = 0; at + kRecord <= sample.start.size(); at += kRecord) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float place = value_at<float>(sample.start, at + 4 * k);
      const float scale = value_at<float>(sample.start, at + 12 + 4 * k);
      const bool plausible = std::abs(place) < kFarthest && scale >= 0 && scale < kLargest &&
                             (place == 0 || std::isnormal(place)) && (scale == 0 || std::isnormal(scale));
      if (!plausible) return false;
    }
  }
  return true;
}

bool is_sog(const Sample& sample) {
  return sample.mentions(".webp") && (sample.mentions("meta.json") || sample.mentions("\"means\""));
}

std::string zip_content(const Sample& sample) {
  if (sample.mentions(".npy"))
    return "holds NumPy arrays (.npz, as SplaTAM's params.npz), which are not read here; write a PLY with "
           "the "
           "program that made it (SplaTAM: scripts/export_ply.py)";
  if (sample.mentions("data.pkl"))
    return "is a PyTorch checkpoint, which is not read here; write a PLY with the program that made it";
  return "is a zip archive; unpack it, and give the map in it";
}

}  // namespace

std::string foreign_map_format(const std::filesystem::path& file) {
  const Sample sample = sample_of(file);
  const std::string& start = sample.start;
  const auto named = [&](const char* ending) { return sample.extension == ending; };
  if (start.starts_with("ply\n") || start.starts_with("ply\r")) return {};
  if (start.starts_with("glTF") || named(".glb") || named(".gltf"))
    return "is a glTF file, which is written but not read here; export the map again as PLY or SPZ from "
           "where "
           "it came from";
  const bool is_zip = start.starts_with("PK\x03\x04");
  if (named(".sog") || ((is_zip || start.starts_with("{")) && is_sog(sample)))
    return "is a map in PlayCanvas' format SOG, which is not read here" + std::string(kConvert);
  if (is_zip) return zip_content(sample);
  if (start.starts_with("\x93NUMPY") || named(".npz") || named(".npy")) return kNumpy;
  if (is_ksplat(sample) || named(".ksplat"))
    return "is a map in the format .ksplat (mkkellogg's), which is not read here" + std::string(kConvert);
  if (named(".splat") || is_splat(sample))
    return "is a map in the format .splat (32 bytes a Gaussian), which is not read here" +
           std::string(kConvert);
  return {};
}

}  // namespace surefield
