// Recordings in logs of messages: .mcap, .db3, .bag.
#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "engine/io/file_names.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/sources/depth_registration.h"
#include "engine/sources/layouts.h"
#include "engine/sources/log_contents.h"
#include "engine/sources/log_geometry.h"
#include "engine/sources/log_images.h"
#include "engine/sources/log_topics.h"
#include "engine/sources/log_truth.h"
#include "engine/sources/pair_by_time.h"
#include "engine/sources/stamp_notes.h"
#include "engine/sources/stamped_rows.h"
#include "engine/sources/undistortion.h"

namespace surefield {

namespace {

struct LogFrame {
  double timestamp = 0;
  double depth_timestamp = 0;
  MessagePlace colour;
  MessagePlace depth;
};

/// All that a recording in a log is.
struct LogSequence {
  std::shared_ptr<const LogReader> log;
  std::string name;
  std::string format;
  LogChoice choice;
  RecordedCamera camera;
  Pose tracked_to_reference = Pose::Identity();
  std::vector<LogFrame> frames;
  int left_out = 0;
  std::vector<std::string> assumptions;
  std::vector<std::string> warnings;
};

class LogRecording : public Recording {
 public:
  explicit LogRecording(LogSequence sequence)
      : sequence_(std::move(sequence)),
        undistortion_(sequence_.camera.intrinsics, sequence_.camera.distortion),
        depth_undistortion_(undistortion_) {
    const auto& depth = sequence_.camera.depth_camera;
    if (!depth) return;
    depth_undistortion_ = Undistortion(depth->intrinsics, depth->distortion);
    registration_ = DepthRegistration{depth->intrinsics, sequence_.camera.intrinsics, depth->depth_to_colour};
  }

  std::string name() const override { return sequence_.name; }
  std::string format() const override { return sequence_.format; }
  int count() const override { return static_cast<int>(sequence_.frames.size()); }
  Intrinsics intrinsics() const override { return sequence_.camera.intrinsics; }
  int left_out() const override { return sequence_.left_out; }
  double depth_unit() const override { return sequence_.camera.depth_unit; }
  double timestamp(int i) const override { return frame(i).timestamp; }
  double depth_timestamp(int i) const override { return frame(i).depth_timestamp; }
  Pose tracked_to_reference() const override { return sequence_.tracked_to_reference; }
  std::vector<std::string> assumptions() const override { return sequence_.assumptions; }
  std::vector<std::string> warnings() const override { return sequence_.warnings; }

  LoadedFrame load(int i) const override {
    try {
      Frame loaded;
      loaded.index = i;
      loaded.timestamp = timestamp(i);
      loaded.depth_after = depth_after(i);
      loaded.colour = undistortion_.colour(colour(frame(i).colour));
      const cv::Mat straight = depth_undistortion_.depth(depth(frame(i).depth));
      loaded.depth = registration_ ? register_depth(straight, *registration_) : straight;
      return {std::move(loaded), ""};
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {
      return {std::nullopt, describe_current_exception()};
    }
  }

 private:
  const LogFrame& frame(int i) const { return sequence_.frames.at(static_cast<std::size_t>(i)); }

  cv::Mat colour(const MessagePlace& place) const {
    const OwnedMessage message = sequence_.log->read(place);
    const Intrinsics& k = sequence_.camera.intrinsics;
    const cv::Size size(k.width, k.height);
    return sequence_.choice.colour.compressed
               ? colour_of(read_compressed_image(message.view()), message.name, size)
               : colour_of(read_image(message.view()), message.name, size);
  }

  cv::Mat depth(const MessagePlace& place) const {
    const OwnedMessage message = sequence_.log->read(place);
    const Intrinsics& k = registration_ ? registration_->depth : sequence_.camera.intrinsics;
    const cv::Size size(k.width, k.height);
    const double unit = sequence_.camera.depth_unit;
    return sequence_.choice.depth.compressed
               ? depth_of(read_compressed_image(message.view()), unit, message.name, size)
               : depth_of(read_image(message.view()), unit, message.name, size);
  }

  LogSequence sequence_;
  Undistortion undistortion_;
  Undistortion depth_undistortion_;
  std::optional<DepthRegistration> registration_;  ///< where depth has a camera of its own
};

struct StampedImage {
  double timestamp = 0;
  MessagePlace place;
};

/// Rounded once, as a stamp that is read from text.
double seconds_of(int64_t nanoseconds) {
  constexpr int64_t kSecond = 1000000000;
  return static_cast<double>(nanoseconds / kSecond) + 1e-9 * static_cast<double>(nanoseconds % kSecond);
}

/// The images of a topic by the stamps in their headers, or by those of the log where all of the former are
/// 0.
std::vector<StampedImage> stamped_images(const LogReader& log, const LogImageTopic& topic,
                                         LogSequence& sequence) {
  std::vector<StampedImage> images, by_log;
  std::size_t damaged = 0;
  bool stamped = false;
  for (const MessagePlace& place : log.places(topic.topic)) {
    try {
      const double stamp = read_message_header(log.read_start(place).view()).stamp;
      stamped |= stamp > 0;
      images.push_back({stamp, place});
      by_log.push_back({seconds_of(place.stamp), place});
    } catch (const InputError&) {
      ++damaged;
    }
  }
  if (damaged > 0)
    sequence.warnings.push_back(
        fmt::format("{} messages of {} are damaged and left out", damaged, topic.name));
  if (!stamped && !images.empty()) {
    sequence.assumptions.push_back(fmt::format(
        "the images of {} have no stamps; those at which they were logged are taken", topic.name));
    images = std::move(by_log);
  }
  sort_by_time(images);
  return images;
}

void read_log_frames(const LogReader& log, const DatasetOptions& options, LogSequence& sequence) {
  const std::vector<StampedImage> colours = stamped_images(log, sequence.choice.colour, sequence);
  std::vector<StampedImage> depths = stamped_images(log, sequence.choice.depth, sequence);
  if (colours.empty() || depths.empty())
    throw InputError(log.path(),
                     "holds no image that can be read of " +
                         (colours.empty() ? sequence.choice.colour.name : sequence.choice.depth.name));
  for (StampedImage& depth : depths) depth.timestamp += options.depth_delay;
  const std::size_t lonely =
      pair_by_time(colours, depths, [&](const StampedImage& colour, const StampedImage& depth) {
        sequence.frames.push_back({colour.timestamp, depth.timestamp, colour.place, depth.place});
      });
  if (sequence.frames.empty()) {
    throw InputError(log.path(),
                     fmt::format("no image of {} has one of {} within {} s; they begin at {:.3f} and "
                                 "{:.3f} s",
                                 sequence.choice.colour.name, sequence.choice.depth.name, kMaxStampDifference,
                                 colours.front().timestamp, depths.front().timestamp));
  }
  sequence.left_out = static_cast<int>(lonely);
  if (lonely > 0)
    sequence.warnings.push_back(
        fmt::format("{} of {} colour images have no depth image within {} s and are left out", lonely,
                    colours.size(), kMaxStampDifference));
}

/// RealSense's SDK stores the unit of its depth images.
std::optional<double> sdk_depth_unit(const LogReader& log, const LogChoice& choice) {
  const auto stream = choice.depth.name.find("/Depth_");
  if (stream == std::string::npos) return std::nullopt;
  const auto topic = log.find(choice.depth.name.substr(0, stream) + "/option/Depth_Units/value");
  const auto spaced = log.find(choice.depth.name.substr(0, stream) + "/option/Depth Units/value");
  const auto found = topic ? topic : spaced;
  if (!found || !log.is(*found, "std_msgs/Float32")) return std::nullopt;
  const auto message = log.first(*found);
  if (!message) return std::nullopt;
  const double unit = read_float(message->view());
  return unit > 0 && unit < 1 ? std::optional(unit) : std::nullopt;
}

double depth_unit_of(const LogReader& log, const LogSequence& sequence, const DatasetOptions& options) {
  if (options.depth_unit) return *options.depth_unit;
  if (sequence.camera.depth_unit > 0) return sequence.camera.depth_unit;
  return sdk_depth_unit(log, sequence.choice).value_or(kMillimetre);
}

void append(std::vector<std::string>& lines, const std::vector<std::string>& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

/// Whether the path is, or holds, a log with that extension. Beside exported images the log may remain; the
/// images are faster to read.
bool is_log_of(const std::filesystem::path& path, const char* extension) {
  const std::vector<std::filesystem::path> files = log_files(path);
  if (files.empty() || lower_extension(files.front()) != extension) return false;
  return !folder_exists(path) ||
         !(is_tum(path) || is_plain(path) || is_scannet(path) || is_replica(path) || is_sevenscenes(path));
}

}  // namespace

bool is_mcap(const std::filesystem::path& path) {
  return is_log_of(path, ".mcap");
}

bool is_db3(const std::filesystem::path& path) {
  return is_log_of(path, ".db3");
}

bool is_bag(const std::filesystem::path& path) {
  return is_log_of(path, ".bag");
}

Dataset open_log_dataset(const std::filesystem::path& path, const DatasetOptions& options) {
  const auto log = std::make_shared<const LogReader>(path);
  LogSequence sequence;
  sequence.log = log;
  sequence.name = folder_exists(path) ? path.filename().string() : path.stem().string();
  sequence.format = lower_extension(log_files(path).front()).substr(1);
  sequence.warnings = log->warnings();
  sequence.choice = choose_topics(*log, options);
  append(sequence.assumptions, sequence.choice.assumptions);
  const FrameTree frames = read_frames_of(*log);
  LogCameras cameras = find_cameras(*log, sequence.choice, frames, options);
  sequence.camera = cameras.camera;
  append(sequence.assumptions, cameras.assumptions);
  append(sequence.warnings, cameras.warnings);
  sequence.camera.depth_unit = depth_unit_of(*log, sequence, options);
  read_log_frames(*log, options, sequence);
  LogTruth truth = find_truth(*log, frames, sequence.choice.colour.frame);
  append(sequence.assumptions, truth.assumptions);
  sequence.tracked_to_reference = truth.tracked_to_reference;
  std::vector<double> stamps;
  for (const LogFrame& frame : sequence.frames) stamps.push_back(frame.timestamp);
  append(sequence.warnings, notes_on_stamps(stamps, truth.topic.empty() ? nullptr : &truth.poses));
  Dataset dataset;
  if (!truth.topic.empty()) dataset.ground_truth = std::move(truth.poses);
  dataset.recording = std::make_unique<LogRecording>(std::move(sequence));
  return dataset;
}

std::vector<ListedTopic> list_topics(const std::filesystem::path& path, const DatasetOptions& options) {
  if (log_files(path).empty()) return {};
  const LogReader log(path);
  std::map<std::string, std::string> uses;
  try {
    const LogChoice choice = choose_topics(log, options);
    const std::string truth = find_truth(log, read_frames_of(log), choice.colour.frame).topic;
    if (!truth.empty()) uses[truth] = "poses";
    if (choice.depth.camera) uses[choice.depth.camera_topic] = "camera of depth";
    if (choice.colour.camera) uses[choice.colour.camera_topic] = "camera of colour";
    uses[choice.depth.name] = "depth";
    uses[choice.colour.name] = "colour";
  } catch (const InputError&) {
    uses.clear();  // opening it says what is missing
  }
  std::vector<ListedTopic> listed;
  for (const LogTopic& topic : log.topics()) listed.push_back({topic, uses[topic.name]});
  std::stable_sort(listed.begin(), listed.end(), [](const ListedTopic& a, const ListedTopic& b) {
    return natural_less(a.topic.name, b.topic.name);
  });
  return listed;
}

}  // namespace surefield
