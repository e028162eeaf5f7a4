// metrics.json; the schema is described in docs/evaluation.md.
#include <fmt/chrono.h>
#include <sys/resource.h>

#include <ctime>

#include "engine/session/frame_table.h"
#include "engine/types/build_info.h"
#include "engine/types/version.h"
#include "tools/results/run_record.h"
#include "tools/results/trajectory_report.h"

namespace surefield {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 1;

/// The most host memory that this process has used, bytes.
double host_peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);  // Linux counts in KiB
}

const char* name(std::optional<RunEnd> end) {
  if (!end) return "running";
  switch (*end) {
    case RunEnd::Completed:
      return "completed";
    case RunEnd::Interrupted:
      return "interrupted";
    default:
      return "failed";
  }
}

/// Null where the delay was not estimated, or nothing was found.
Json depth_delay_error(const RunRecord& record) {
  const bool known = record.estimated_depth_delay && record.estimated_depth_delay->known();
  return known ? Json(record.estimated_depth_delay->error) : Json(nullptr);
}

Json dataset_json(const RunRecord& record) {
  return {
      {"name", record.dataset},
      {"path", record.dataset_path.empty() ? Json(nullptr) : Json(record.dataset_path)},
      {"format", record.format},
      {"width", record.intrinsics.width},
      {"height", record.intrinsics.height},
      {"start", record.selection.start},
      {"stride", record.selection.stride},
      {"scale", record.selection.scale},
      {"depth_max_m", record.depth_max},
      {"depth_delay_s", record.depth_delay},
      {"depth_delay_error_s", depth_delay_error(record)},
      {"assumed_camera", record.assumed_camera.empty() ? Json(nullptr) : Json(record.assumed_camera)},
      {"assumed_depth_unit_m", record.assumed_depth_unit ? Json(*record.assumed_depth_unit) : Json(nullptr)},
      {"colour_topic", record.colour_topic.empty() ? Json(nullptr) : Json(record.colour_topic)},
      {"depth_topic", record.depth_topic.empty() ? Json(nullptr) : Json(record.depth_topic)}};
}

Json frames_json(const RunRecord& record) {
  return {
      {"total", record.selected ? Json(*record.selected) : Json(nullptr)},
      {"fed", record.frames.size()},
      {"skipped", record.skipped.size()},
      {"lost", count_frames(record.frames, [](const FrameReport& frame) { return frame.lost(); })},
      {"poor", count_frames(record.frames,
                            [](const FrameReport& frame) { return frame.state == TrackingState::Poor; })},
      {"pose_share", record.frames.empty() ? Json(nullptr) : Json(record.pose_share())},
      {"doubtful_end", record.doubtful_end()},
      {"retried", count_frames(record.frames, [](const FrameReport& frame) { return frame.retries > 0; })},
      {"keyframes", record.keyframes.size()}};
}

Json time_json(const RunRecord& record) {
  const IterationTotal tracking = tracking_total(record.frames);
  const IterationTotal mapping = mapping_total(record.frames);
  return {{"setup_s", record.setup_seconds},
          {"total_s", record.seconds},
          {"frames_per_second", record.frames_per_second()},
          {"tracking_s", tracking.seconds},
          {"tracking_iterations", tracking.iterations},
          {"tracking_ms_per_iteration", tracking.milliseconds_each()},
          {"mapping_s", mapping.seconds},
          {"mapping_iterations", mapping.iterations},
          {"mapping_ms_per_iteration", mapping.milliseconds_each()}};
}

Json latency_json(const std::optional<Latency>& latency) {
  if (!latency) return nullptr;
  return {{"median", latency->median}, {"p95", latency->most}};
}

Json live_json(const std::optional<LiveRecord>& live) {
  if (!live) return nullptr;
  return {{"arrived", live->counts.arrived},
          {"dropped", live->counts.dropped},
          {"rate_hz", live->counts.rate()},
          {"latency_ms", latency_json(live->from_arrival)},
          {"stamp_latency_ms", latency_json(live->from_stamp)}};
}

}  // namespace

std::string metrics_json(const RunRecord& record, const nlohmann::ordered_json& files) {
  Json json;
  json["schema"] = "surefield-metrics";
  json["version"] = kSchemaVersion;
  json["run"] = files;
  json["status"] = name(record.end);
  json["error"] = record.error.empty() ? Json(nullptr) : Json(record.error);
  json["date"] = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
  json["program"] = {{"version", kVersion}, {"commit", kGitCommit}};
  json["device"] = {{"name", record.engine.device}, {"driver", record.engine.driver}};
  json["dataset"] = dataset_json(record);
  json["frames"] = frames_json(record);
  json["time"] = time_json(record);
  json["live"] = live_json(record.live);
  json["map"] = {{"gaussians", record.gaussians()},
                 {"megabytes", static_cast<double>(record.engine.map_bytes) / kMegabyte}};
  json["up"] = record.up ? Json({{"direction", {record.up->up.x(), record.up->up.y(), record.up->up.z()}},
                                 {"measured", record.up->measured},
                                 {"given", record.up->given}})
                         : Json(nullptr);
  json["loops"] = {{"looked_at", record.loops.size()}, {"accepted", count_loops(record.loops)}};
  json["memory"] = {{"device_peak_mb", static_cast<double>(record.engine.device_peak_bytes) / kMegabyte},
                    {"host_peak_mb", host_peak_bytes() / kMegabyte}};
  json["trajectory"] = trajectory_json(record.accuracy);
  json["images"] = quality_json(record.images);
  json["skipped"] = Json::array();
  for (const SkippedFrame& frame : record.skipped) {
    json["skipped"].push_back({{"index", frame.index}, {"reason", frame.reason}});
  }
  json["per_frame"] = Json::array();
  for (const FrameReport& frame : record.frames) json["per_frame"].push_back(frame_json(frame));
  // File names in reasons may be in any encoding.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace surefield
