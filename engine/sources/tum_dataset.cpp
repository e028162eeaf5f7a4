// TUM RGB-D: rgb.txt and depth.txt list "timestamp file", or associations.txt lists pairs; groundtruth.txt is
// a trajectory.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/io/camera_json.h"
#include "engine/io/files.h"
#include "engine/io/json_file.h"
#include "engine/io/text_file.h"
#include "engine/io/trajectory_formats.h"
#include "engine/sources/layouts.h"
#include "engine/sources/pair_by_time.h"
#include "engine/sources/stamped_rows.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

/// The camera of the benchmark that the name of a sequence tells; empty where it tells none.
std::string camera_by_name(const std::string& name) {
  if (name.find("bonn") != std::string::npos) return "bonn";
  for (const std::string number : {"1", "2", "3"})
    for (const char* prefix : {"freiburg", "fr"})
      if (name.find(prefix + number) != std::string::npos) return "freiburg" + number;
  return {};
}

/// Own recordings in this layout bring camera.yaml or cam_params.json; for the benchmark's sequences the
/// folder's name tells.
void read_tum_calibration(const std::filesystem::path& folder, const DatasetOptions& options,
                          StoredSequence& sequence) {
  if (const auto own = own_camera(folder, options, sequence.assumptions)) return use_camera(*own, sequence);
  const std::filesystem::path file = folder / "cam_params.json";
  if (file_exists(file)) {
    const JsonObject camera = JsonObject(file).object("camera");
    sequence.intrinsics = read_intrinsics(camera, "w", "h");
    sequence.depth_encoding.unit = 1 / camera.positive("scale");
    return;
  }
  if (const auto eth3d = folder / "calibration.txt"; file_exists(eth3d)) {
    use_camera(read_eth3d_camera(eth3d), sequence);
    sequence.assumptions.push_back(
        "calibration.txt is ETH3D's, its pixel centres at integers, and depth in 1/5000 m");
    return;
  }
  const std::string known = camera_by_name(sequence.name);
  if (known.empty()) {
    throw InputError(
        folder,
        "the camera is unknown: the folder's name has none of freiburg1, freiburg2, freiburg3 (or fr1, "
        "fr2, fr3) and bonn, and there is no camera.yaml with width, height, fx, fy, cx, cy, depth_unit (nor "
        "cam_params.json with w, h, fx, fy, cx, cy, scale under \"camera\", nor ETH3D's calibration.txt); "
        "write one, or name the camera "
        "(surefield run --assume-camera)");
  }
  use_camera(known_camera(known), sequence);
  sequence.assumptions.push_back(
      fmt::format("the camera is {}, by the folder's name",
                  known == "bonn" ? "that of Bonn's sequences" : "TUM's " + known));
}

struct ListedImage {
  double timestamp = 0;
  std::filesystem::path file;
};

/// A row: a stamp, and the name of the file, which may have blanks.
ListedImage parse_row(const std::filesystem::path& file, const TextLine& line) {
  const std::vector<std::string> fields = split_fields(line.text);
  const auto stamp = fields.size() < 2 ? std::nullopt : parse_number(fields[0]);
  if (!stamp || !std::isfinite(*stamp)) throw InputError(file, line.number, "expected \"timestamp file\"");
  std::filesystem::path name = fields[1];
  if (fields.size() > 2) name = line.text.substr(line.text.find(fields[1]));
  return {*stamp * stamp_unit(*stamp), file.parent_path() / name};
}

/// The images of a list in the order of their stamps.
std::vector<ListedImage> read_list(const std::filesystem::path& file, StoredSequence& sequence) {
  return read_stamped_rows(file, sequence, [&](const TextLine& line) { return parse_row(file, line); });
}

/// Pairs each colour image with the depth image that is nearest in time.
void pair_by_stamps(const std::vector<ListedImage>& colours, const std::vector<ListedImage>& depths,
                    const std::filesystem::path& folder, StoredSequence& sequence) {
  const std::size_t lonely =
      pair_by_time(colours, depths, [&](const ListedImage& colour, const ListedImage& depth) {
        sequence.frames.push_back({colour.timestamp, colour.file, depth.file, depth.timestamp});
      });
  if (sequence.frames.empty()) {
    throw InputError(folder,
                     fmt::format("no colour image has a depth image within 0.02 s; they begin at {:.3f} and "
                                 "{:.3f} s",
                                 colours.front().timestamp, depths.front().timestamp));
  }
  sequence.left_out = static_cast<int>(lonely);
  if (lonely > 0) {
    sequence.warnings.push_back(fmt::format(
        "{} of {} colour images have no depth image within 0.02 s and are left out", lonely, colours.size()));
  }
}

bool has_image_lists(const std::filesystem::path& folder) {
  return file_exists(folder / "rgb.txt") && file_exists(folder / "depth.txt");
}

/// The frames of the two lists, or of the list of pairs; that is paired anew where depth images are known to
/// be late.
void read_frames(const std::filesystem::path& folder, double depth_delay, StoredSequence& sequence) {
  std::vector<ListedImage> colours, depths;
  if (has_image_lists(folder)) {
    colours = read_list(folder / "rgb.txt", sequence);
    depths = read_list(folder / "depth.txt", sequence);
  } else {
    sequence.frames = read_pair_list(*find_pair_list(folder), sequence);
    if (depth_delay == 0) return;
    for (const StoredFrame& frame : std::exchange(sequence.frames, {})) {
      colours.push_back({frame.timestamp, frame.colour});
      depths.push_back({*frame.depth_timestamp, frame.depth});
    }
    sort_by_time(depths);
  }
  for (ListedImage& depth : depths) depth.timestamp += depth_delay;
  pair_by_stamps(colours, depths, folder, sequence);
}

}  // namespace

bool is_tum(const std::filesystem::path& folder) {
  return has_image_lists(folder) || (find_pair_list(folder) && !is_icl(folder));
}

StoredSequence read_tum_sequence(const std::filesystem::path& folder, const DatasetOptions& options) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "tum";
  read_frames(folder, options.depth_delay, sequence);
  read_tum_calibration(folder, options, sequence);
  const std::filesystem::path truth = folder / "groundtruth.txt";
  if (file_exists(truth))
    read_truth(sequence, [&] { return read_any_trajectory(truth, {.stamps = stamps_of(sequence)}).poses; });
  return sequence;
}

}  // namespace surefield
