#include "engine/synth/sequence_writer.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/io/trajectory_file.h"
#include "engine/sources/camera_file.h"
#include "engine/synth/scene_mesh.h"
#include "engine/types/error.h"

namespace surefield {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSettingsFile = "synth.json";
constexpr int kJpegQuality = 98;
constexpr double kReplicaStepsPerMetre = 6553.5;
constexpr double kTumStepsPerMetre = 5000;

/// Everything that a sequence may consist of.
constexpr std::array<const char*, 11> kOwnEntries = {
    "results",   "traj.txt",        "cam_params.json", "rgb",      "depth", "rgb.txt",
    "depth.txt", "groundtruth.txt", kCameraFile,       "mesh.ply", "beside"};

void prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder, "cannot be created: " + error.message());
  if (fs::is_empty(folder)) return;
  if (!fs::exists(folder / kSettingsFile)) {
    throw InputError(folder, "holds files that are no synthetic sequence; give an empty or a new folder");
  }
  for (const char* name : kOwnEntries) {
    fs::remove_all(folder / name, error);
    if (error) throw InputError(folder / name, "cannot be replaced: " + error.message());
  }
}

void create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) throw InputError(folder, "cannot be created: " + error.message());
}

const char* name_of(ExposureCourse course) {
  switch (course) {
    case ExposureCourse::Jump:
      return "jump";
    case ExposureCourse::Double:
      return "double";
    case ExposureCourse::FadeIn:
      return "fade-in";
    case ExposureCourse::Drift:
      break;
  }
  return "drift";
}

std::string stamped(const char* folder, double stamp) {
  return fmt::format("{}/{:.6f}.png", folder, stamp);
}

std::string matrix_row(const Eigen::Matrix4d& matrix) {
  std::string line;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      line += fmt::format("{}{:.12g}", line.empty() ? "" : " ", matrix(row, column) + 0.0);
  return line + "\n";
}

}  // namespace

SequenceWriter::SequenceWriter(fs::path folder, SequenceLayout layout, const SyntheticRecording& recording)
    : folder_(std::move(folder)), layout_(layout), recording_(recording) {
  prepare_folder(folder_);
  write_settings(false);
  write_mesh(folder_ / "mesh.ply", make_scene_mesh(recording.scene()));
  write_camera();
  for (const char* name :
       layout_ == SequenceLayout::Replica ? std::vector{"results"} : std::vector{"rgb", "depth"})
    create_folder(folder_ / name);
}

void SequenceWriter::write_settings(bool complete) const {
  const SynthSettings& s = recording_.settings();
  const std::optional<int> moved = recording_.chair_moved_at();
  const nlohmann::json chair = moved ? nlohmann::json(*moved) : nlohmann::json();
  const nlohmann::json json = {{"schema", "surefield-synth"},
                               {"version", 1},
                               {"scene", s.scene},
                               {"path", s.path},
                               {"seed", s.seed},
                               {"frames", s.frames},
                               {"beside", s.beside},
                               {"width", s.width},
                               {"height", s.height},
                               {"sensor", s.sensor == SensorKind::Kinect ? "kinect" : "perfect"},
                               {"layout", layout_ == SequenceLayout::Tum ? "tum" : "replica"},
                               {"moving_object", s.moving_object},
                               {"chair_moved_at", chair},
                               {"range_m", s.kinect.furthest},
                               {"colour_delay_s", s.kinect.colour_delay},
                               {"depth_readout_s", s.kinect.depth_readout_seconds},
                               {"exposure", name_of(s.kinect.course)},
                               {"exposure_from", s.exposure_from.value_or(s.frames / 2)},
                               {"complete", complete}};
  write_file(folder_ / kSettingsFile, [&](std::ostream& stream) { stream << json.dump(2) << "\n"; });
}

void SequenceWriter::write_camera() const {
  const Intrinsics k = recording_.intrinsics();
  if (layout_ == SequenceLayout::Tum) {
    return write_file(folder_ / kCameraFile, [&](std::ostream& stream) {
      stream << fmt::format("width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\ndepth_unit: {}\n",
                            k.width, k.height, k.fx, k.fy, k.cx, k.cy, 1 / kTumStepsPerMetre);
    });
  }
  const nlohmann::json camera = {{"w", k.width},
                                 {"h", k.height},
                                 {"fx", k.fx},
                                 {"fy", k.fy},
                                 {"cx", k.cx},
                                 {"cy", k.cy},
                                 {"scale", kReplicaStepsPerMetre}};
  write_file(folder_ / "cam_params.json", [&](std::ostream& stream) {
    stream << nlohmann::json{{"camera", camera}}.dump(2) << "\n";
  });
}

void SequenceWriter::write_depth(const fs::path& name, const cv::Mat& metres) const {
  const double per_metre = layout_ == SequenceLayout::Tum ? kTumStepsPerMetre : kReplicaStepsPerMetre;
  cv::Mat steps(metres.size(), CV_16UC1);
  for (int v = 0; v < metres.rows; ++v) {
    for (int u = 0; u < metres.cols; ++u) {
      const double step = std::round(metres.at<float>(v, u) * per_metre);
      steps.at<uint16_t>(v, u) = step <= 65535 ? static_cast<uint16_t>(step) : uint16_t{0};
    }
  }
  write_png(folder_ / name, steps);
}

void SequenceWriter::write(int i) {
  const Frame frame = recording_.load(i).frame.value();
  if (layout_ == SequenceLayout::Tum) {
    write_png(folder_ / stamped("rgb", recording_.colour_timestamp(i)), frame.colour);
    write_depth(stamped("depth", recording_.timestamp(i)), frame.depth);
  } else {
    write_jpeg(folder_ / fmt::format("results/frame{:06}.jpg", i), frame.colour, kJpegQuality);
    write_depth(fmt::format("results/depth{:06}.png", i), frame.depth);
  }
  written_ = i + 1;
}

void SequenceWriter::write_tum_lists() const {
  Trajectory truth;
  std::string colours, depths;
  for (int i = 0; i < written_; ++i) {
    const double colour = recording_.colour_timestamp(i), depth = recording_.timestamp(i);
    colours += fmt::format("{:.6f} {}\n", colour, stamped("rgb", colour));
    depths += fmt::format("{:.6f} {}\n", depth, stamped("depth", depth));
    truth.push_back({depth, recording_.true_pose(depth)});
    if (colour != depth) truth.push_back({colour, recording_.true_pose(colour)});
  }
  write_file(folder_ / "depth.txt", [&](std::ostream& stream) { stream << depths; });
  write_file(folder_ / "rgb.txt", [&](std::ostream& stream) { stream << colours; });
  write_trajectory(folder_ / "groundtruth.txt", truth);
}

void SequenceWriter::finish() {
  if (layout_ == SequenceLayout::Tum) {
    write_tum_lists();
  } else {
    write_file(folder_ / "traj.txt", [&](std::ostream& stream) {
      for (int i = 0; i < written_; ++i)
        stream << matrix_row(recording_.true_pose(recording_.timestamp(i)).matrix());
    });
  }
  write_settings(written_ == recording_.count());
}

}  // namespace surefield
