// Writes the seeds that are no text: a map and images in each binary format.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>

#include "engine/formats/map_file.h"
#include "engine/formats/triangle_mesh.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/types/gaussian_cloud.h"
#include "tests/support/stream_writer.h"

using namespace surefield;

namespace {

GaussianCloud small_cloud() {
  GaussianCloud cloud;
  cloud.resize(3);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.means[i] = {static_cast<float>(i), 0, 1};
    cloud.log_scales[i] = {-3, -3, -4};
  }
  return cloud;
}

/// A framed stream with a frame of raw images and one of compressed ones.
std::string small_stream(const std::filesystem::path& colour, const std::filesystem::path& depth) {
  test::HeaderToSend header;
  header.width = 7;
  header.height = 5;
  test::FrameToSend raw, packed;
  raw.colour.resize(3 * 5 * 7);
  raw.depth.resize(2 * 5 * 7);
  packed.stamp = 1;
  packed.colour_kind = 3;
  packed.depth_kind = 1;
  packed.colour = read_file(colour);
  packed.depth = read_file(depth);
  return header.message() + raw.message() + packed.message() + test::end_message();
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::filesystem::path root = arguments[1];
  for (const char* reader : {"map_ply", "map_spz", "mesh", "colour", "depth", "tiff", "frame_stream"})
    std::filesystem::create_directories(root / reader);
  const GaussianCloud cloud = small_cloud();
  write_map(root / "map_ply/binary", cloud, MapFormat::Ply);
  write_map(root / "map_ply/compressed", cloud, MapFormat::CompressedPly);
  write_map(root / "map_spz/map", cloud, MapFormat::Spz);
  write_mesh(root / "mesh/binary", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}});
  write_png(root / "colour/png", cv::Mat(5, 7, CV_8UC3, cv::Scalar(1, 2, 3)));
  write_jpeg(root / "colour/jpeg", cv::Mat(5, 7, CV_8UC3, cv::Scalar(1, 2, 3)), 90);
  write_png(root / "depth/png", cv::Mat(5, 7, CV_16UC1, cv::Scalar(1000)));
  write_tiff(root / "tiff/float", cv::Mat(5, 7, CV_32FC1, cv::Scalar(1.5)));
  std::ofstream(root / "frame_stream/stream", std::ios::binary)
      << small_stream(root / "colour/png", root / "depth/png");
  std::ofstream(root / "made") << "";
}
