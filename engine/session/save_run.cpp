#include "engine/session/save_run.h"

#include "engine/formats/map_file.h"
#include "engine/io/files.h"
#include "engine/io/trajectory_file.h"
#include "engine/session/frame_table.h"
#include "engine/session/loop_table.h"
#include "engine/types/gaussian_cloud.h"

namespace surefield {

namespace {

/// Saves the map in one format and removes what an earlier run left in another, which is not this run's map.
void save_map(ResultsFolder& results, const Slam& slam, const std::string& format) {
  for (const std::string& other : run_map_formats())
    if (other != format) results.remove("map." + other);
  results.save("map." + format, [&](const auto& file) { write_map(file, slam.map()); });
}

std::vector<int> keyframe_indices(const Slam& slam) {
  std::vector<int> indices;
  for (const FrameReport& report : slam.reports())
    if (report.keyframe) indices.push_back(report.index);
  return indices;
}

}  // namespace

void save_run(ResultsFolder& results, const Slam& slam, const FrameSource& source,
              const std::string& map_format) {
  const auto save_trajectory = [&](const std::string& name, const Trajectory& tracked) {
    results.save(name,
                 [&](const auto& file) { write_trajectory(file, of_reference_camera(tracked, source)); });
  };
  save_trajectory("trajectory.txt", slam.trajectory());
  save_trajectory("keyframes.txt", slam.keyframes());
  save_trajectory("trajectory_online.txt", slam.online_trajectory());
  results.save("loops.csv", [&](const auto& file) {
    write_file(file, [&](std::ostream& stream) { stream << loops_csv(slam.loops(), keyframe_indices(slam)); });
  });
  save_map(results, slam, map_format);
  results.save("frames.csv", [&](const auto& file) {
    write_file(file, [&](std::ostream& stream) { stream << frames_csv(slam.reports()); });
  });
}

}  // namespace surefield
