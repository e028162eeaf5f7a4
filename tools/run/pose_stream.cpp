#include "tools/run/pose_stream.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "engine/session/frame_table.h"
#include "engine/types/error.h"
#include "tools/shared/say.h"

namespace surefield {

namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Pose& camera_to_world) {
  const Eigen::Vector3d t = camera_to_world.translation();
  const Eigen::Quaterniond q(camera_to_world.linear());
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Writes lines to a file until one cannot be written, which is said.
class LineFile {
 public:
  explicit LineFile(std::string path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "w")) {
    if (!file_)
      throw InputError(path_, "cannot be written to; --poses takes a file in a folder that is there");
  }
  bool operator()(const std::string& line) {
    if (std::fputs(line.c_str(), file_.get()) >= 0 && std::fflush(file_.get()) == 0) return true;
    say(stderr, "surefield: warning: {} takes no more poses; the run goes on without\n", path_);
    return false;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace

void PoseStream::add_place(const std::string& place) {
  if (place == "-") {
    add_sink([](const std::string& line) {
      say_text(stdout, line);
      return true;
    });
  } else {
    add_sink([file = std::make_shared<LineFile>(place)](const std::string& line) { return (*file)(line); });
  }
}

void PoseStream::begin(const RunStart& start) {
  reference_to_tracked_ = start.source.tracked_to_reference().inverse();
}

void PoseStream::tracked(const Frame&, const FrameReport& report) {
  write(line_of({{"index", report.index},
                 {"stamp", report.timestamp},
                 {"state", name_of(report.state)},
                 {"keyframe", report.keyframe},
                 {"map_revision", revision_},
                 {"camera_to_world", numbers(report.world_to_camera.inverse() * reference_to_tracked_)}}));
}

void PoseStream::fed(const Frame&, const Slam& slam, const FrameReport&) {
  revision_ = slam.revision();
}

void PoseStream::skipped(const SkippedFrame& frame) {
  write(line_of({{"index", frame.index}, {"state", "skipped"}, {"reason", frame.reason}}));
}

void PoseStream::finished(const Slam& slam) {
  write(line_of({{"state", "ended"}, {"map_revision", slam.revision()}}));
}

/// Gives a line to all that still take some.
void PoseStream::write(const std::string& line) {
  std::erase_if(sinks_, [&](const Sink& sink) { return !sink(line); });
}

}  // namespace surefield
