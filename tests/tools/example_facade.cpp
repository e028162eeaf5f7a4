// How another program uses Surefield as a library: feed frames, get poses and the map, save them.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "engine/formats/ply.h"
#include "engine/io/trajectory_file.h"
#include "engine/slam/slam.h"
#include "engine/sources/frame_stream.h"
#include "engine/synth/synthetic_recording.h"

int main() {
  using namespace surefield;
  try {
    EngineOptions engine;
    if (const char* device = std::getenv("SUREFIELD_DEVICE")) engine.device = device;
    // Any source does: open_dataset("path/of/a/sequence") recognises the layout of the common recordings.
    const SyntheticRecording recording({.selector = engine.device}, {.width = 64, .height = 48, .frames = 3});
    FrameStream stream(recording, {});

    // Few steps, so that this example takes a moment only; the defaults suit real sequences.
    SlamSettings settings;
    settings.first_iterations = 10;
    settings.tracking.adam.first_iterations = 20;

    Slam slam(settings, stream.intrinsics(), engine);
    while (const auto frame = stream.next()) {
      const FrameReport report = slam.feed(*frame);
      const Eigen::Vector3d position = report.world_to_camera.inverse().translation();
      std::printf("frame %d: camera at %.3f %.3f %.3f m, %u Gaussians\n", report.index, position.x(),
                  position.y(), position.z(), report.gaussians);
    }
    slam.finish();
    write_trajectory("example_trajectory.txt", slam.trajectory());
    write_ply("example_map.ply", slam.map());
    const bool complete = slam.trajectory().size() == 3 && std::filesystem::file_size("example_map.ply") > 0;
    return complete ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
