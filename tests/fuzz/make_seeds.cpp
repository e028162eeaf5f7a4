// Writes the seeds that are no text: a map and images in each binary format.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>

#include "engine/formats/map_file.h"
#include "engine/formats/triangle_mesh.h"
#include "engine/io/images.h"
#include "engine/types/gaussian_cloud.h"

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

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::filesystem::path root = arguments[1];
  for (const char* reader : {"map_ply", "map_spz", "mesh", "colour", "depth", "tiff"})
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
  std::ofstream(root / "made") << "";
}
