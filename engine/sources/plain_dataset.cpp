// The layout for recordings of one's own: colour/ (or color/, rgb/) and depth/ with images paired by their
// names, or by timestamps.txt; camera.yaml; poses.txt where poses are known.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/io/trajectory_formats.h"
#include "engine/sources/layouts.h"
#include "engine/sources/stamped_rows.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kMostApart = 0.02;     // seconds between images that are named by their stamps
constexpr double kEarliestClock = 1e8;  // seconds since 1970, from which a name is the reading of a clock

using Images = std::map<std::string, std::filesystem::path, NaturalOrder>;

std::filesystem::path colour_folder(const std::filesystem::path& folder) {
  for (const char* name : {"colour", "color", "rgb"})
    if (folder_exists(folder / name)) return folder / name;
  return folder / "colour";
}

/// The image of a row of timestamps.txt, given by its name in `images` or as a path in the dataset.
std::filesystem::path listed_image(const std::filesystem::path& images, const std::string& name) {
  const std::filesystem::path in_folder = find_spelling(images / name);
  if (file_exists(in_folder)) return in_folder;
  const std::filesystem::path in_dataset = find_spelling(images.parent_path() / name);
  return file_exists(in_dataset) ? in_dataset : in_folder;
}

/// A row "seconds colour-file depth-file".
StoredFrame parse_frame(const std::filesystem::path& file, const TextLine& line) {
  const std::filesystem::path folder = file.parent_path();
  const std::vector<std::string> fields = split_fields(line.text);
  const auto stamp = fields.size() == 3 ? parse_number(fields[0]) : std::nullopt;
  if (!stamp || !std::isfinite(*stamp))
    throw InputError(file, line.number, "expected \"seconds colour-file depth-file\"");
  return {*stamp * stamp_unit(*stamp), listed_image(colour_folder(folder), fields[1]),
          listed_image(folder / "depth", fields[2])};
}

/// Rows of one number: the stamps of the frames in their order. False where the file has other rows.
bool read_times(const std::filesystem::path& file, StoredSequence& sequence) {
  std::vector<double> times;
  for (const TextLine& line : read_rows(file)) {
    const auto time = parse_number(line.text);
    if (!time) return false;
    times.push_back(*time * stamp_unit(*time));
  }
  if (times.size() != sequence.frames.size()) {
    throw InputError(
        file, fmt::format("has {} time stamps for {} pairs of images", times.size(), sequence.frames.size()));
  }
  for (std::size_t i = 0; i < times.size(); ++i) sequence.frames[i].timestamp = times[i];
  return true;
}

/// The images by the stamps that they are named by, seconds; empty where they have other names.
std::map<double, std::filesystem::path> by_stamp(const Images& images) {
  std::map<double, std::filesystem::path> stamped;
  for (const auto& [stem, file] : images) {
    const auto stamp = parse_number(stem);
    const double seconds = stamp ? *stamp * stamp_unit(*stamp) : 0;
    if (!(seconds > kEarliestClock) || !std::isfinite(seconds)) return {};
    stamped.emplace(seconds, file);
  }
  return stamped;
}

/// Pairs images that are named by the time at which each was taken.
bool pair_by_stamped_names(const Images& colours, const Images& depths, StoredSequence& sequence) {
  const auto depth_by_stamp = by_stamp(depths);
  for (const auto& [stamp, colour] : by_stamp(colours)) {
    auto nearest = depth_by_stamp.lower_bound(stamp);
    if (nearest == depth_by_stamp.end() ||
        (nearest != depth_by_stamp.begin() && stamp - std::prev(nearest)->first < nearest->first - stamp)) {
      if (nearest == depth_by_stamp.begin()) return false;
      --nearest;
    }
    if (std::abs(nearest->first - stamp) <= kMostApart)
      sequence.frames.push_back({stamp, colour, nearest->second, nearest->first});
  }
  if (sequence.frames.empty()) return false;
  sequence.assumptions.push_back("the names of the images are their time stamps");
  return true;
}

/// The last number in a name without leading zeros; the name itself where it has none.
std::string number_key(const std::string& stem) {
  constexpr const char* kDigits = "0123456789";
  const auto last = stem.find_last_of(kDigits);
  if (last == std::string::npos) return stem;
  const auto before = stem.find_last_not_of(kDigits, last);  // npos + 1 is 0
  const std::string digits = stem.substr(before + 1, last - before);
  const auto significant = digits.find_first_not_of('0');
  return significant == std::string::npos ? "0" : digits.substr(significant);
}

/// Pairs images of equal names, or of equal numbers in their names, in natural order; the stamp is the index,
/// in seconds.
template <typename Key>
void pair_by(const Images& colours, const Images& depths, Key key, StoredSequence& sequence) {
  std::map<std::string, std::filesystem::path> depth_by_key;
  for (const auto& [stem, file] : depths)
    if (!depth_by_key.emplace(key(stem), file).second) return;
  std::set<std::string> used;
  std::vector<StoredFrame> frames;
  for (const auto& [stem, colour] : colours) {
    const auto depth = depth_by_key.find(key(stem));
    if (depth == depth_by_key.end()) continue;
    if (!used.insert(depth->first).second) return;
    frames.push_back({static_cast<double>(frames.size()), colour, depth->second});
  }
  sequence.frames = std::move(frames);
}

void pair_by_name(const std::filesystem::path& folder, StoredSequence& sequence) {
  const Images colours = images_by_stem(colour_folder(folder)), depths = images_by_stem(folder / "depth");
  pair_by(
      colours, depths, [](const std::string& stem) { return stem; }, sequence);
  const bool few = 2 * sequence.frames.size() < std::min(colours.size(), depths.size());
  if (few && pair_by_stamped_names(colours, depths, sequence)) return;
  if (sequence.frames.empty()) {
    pair_by(colours, depths, number_key, sequence);
    if (!sequence.frames.empty())
      sequence.assumptions.push_back(
          "colour and depth images with the same number in their names are a pair");
  }
  if (sequence.frames.empty()) {
    throw InputError(folder, fmt::format("none of the {} colour images has a depth image of the same name "
                                         "(extensions aside); rename them, or pair them in timestamps.txt",
                                         colours.size()));
  }
  const std::size_t lonely = colours.size() + depths.size() - 2 * sequence.frames.size();
  if (lonely > 0) {
    sequence.warnings.push_back(
        fmt::format("{} colour or depth images have no partner of the same name and are left out", lonely));
  }
}

/// Where the images are named by time stamps too, those are the stamps.
void take_stamps_from_names(StoredSequence& sequence) {
  Images colours;
  for (const StoredFrame& frame : sequence.frames)
    colours.emplace(frame.colour.stem().string(), frame.colour);
  const auto stamped = by_stamp(colours);
  if (stamped.size() != sequence.frames.size()) return;
  auto next = stamped.begin();
  for (StoredFrame& frame : sequence.frames) frame.timestamp = (next++)->first;
  sequence.assumptions.push_back("the names of the images are their time stamps");
}

void read_frames(const std::filesystem::path& folder, StoredSequence& sequence) {
  const std::filesystem::path list = folder / "timestamps.txt";
  const bool listed = file_exists(list);
  if (listed) {
    const auto rows = read_rows(list);
    const bool times_alone = !rows.empty() && parse_number(rows.front().text).has_value();
    if (!times_alone) {
      sequence.frames =
          read_stamped_rows(list, sequence, [&](const TextLine& line) { return parse_frame(list, line); });
      return;
    }
  }
  pair_by_name(folder, sequence);
  if (listed) {
    if (!read_times(list, sequence)) throw InputError(list, "expected a time stamp, seconds, in each line");
  } else if (!sequence.frames.front().depth_timestamp) {
    take_stamps_from_names(sequence);
  }
}

/// The camera that the recorder of Open3D has left, if it was that.
std::optional<std::filesystem::path> open3d_camera(const std::filesystem::path& folder) {
  for (const char* name : {"camera_intrinsic.json", "intrinsic.json"})
    if (file_exists(folder / name)) return folder / name;
  return std::nullopt;
}

void read_plain_camera(const std::filesystem::path& folder, const DatasetOptions& options,
                       StoredSequence& sequence) {
  if (const auto own = own_camera(folder, options, sequence.assumptions)) return use_camera(*own, sequence);
  const std::filesystem::path file = *open3d_camera(folder);
  use_camera(read_open3d_camera(file), sequence);
  sequence.assumptions.push_back(fmt::format("the camera is that of Open3D's {}, depth in steps of {:g} m",
                                             file.filename().string(), sequence.depth_encoding.unit));
}

}  // namespace

bool is_plain(const std::filesystem::path& folder) {
  const std::filesystem::path colour = colour_folder(folder);
  const bool lists = file_exists(folder / "rgb.txt") || find_pair_list(folder);
  return folder_exists(colour) && folder_exists(folder / "depth") && !folder_exists(folder / "intrinsic") &&
         !(lists && colour.filename() == "rgb");
}

StoredSequence read_plain_sequence(const std::filesystem::path& folder, const DatasetOptions& options) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "plain";
  if (options.camera.empty() && !file_exists(folder / kCameraFile) && !open3d_camera(folder)) {
    throw InputError(folder,
                     "camera.yaml is missing: fx, fy, cx, cy and depth_unit, see docs/datasets.md (or "
                     "Open3D's camera_intrinsic.json; and a folder exported from ScanNet has intrinsic/)");
  }
  read_frames(folder, sequence);
  read_plain_camera(folder, options, sequence);
  const std::filesystem::path poses = folder / "poses.txt";
  if (file_exists(poses))
    read_truth(sequence, [&] { return read_any_trajectory(poses, {.stamps = stamps_of(sequence)}).poses; });
  return sequence;
}

}  // namespace surefield
