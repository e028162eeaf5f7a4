// Runs SLAM over a recording in any layout that Surefield knows and writes the trajectory and the map.
#include <surefield/formats/map_file.h>
#include <surefield/io/trajectory_file.h>
#include <surefield/slam/slam.h>
#include <surefield/sources/frame_stream.h>
#include <surefield/sources/open_dataset.h>
#include <surefield/types/error.h>

#include <cstdio>

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fprintf(stderr, "usage: run_recording FOLDER\n");
    return 2;
  }
  const auto dataset = surefield::open_dataset(arguments[1]);
  surefield::FrameStream frames(*dataset.recording, {.frames = 30, .scale = 0.25});
  surefield::Slam slam(surefield::SlamSettings{}, frames.intrinsics());
  while (const auto frame = frames.next()) slam.feed(*frame);
  slam.finish();
  surefield::write_trajectory("trajectory.txt", slam.trajectory());
  surefield::write_map("map.ply", slam.map());
  std::printf("%zu poses, %zu Gaussians\n", slam.trajectory().size(), slam.map().size());
} catch (const surefield::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
