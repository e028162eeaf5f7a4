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
#include "tests/support/log_writers.h"
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

/// One frame of 4 x 3 pixels with its camera.
std::vector<test::WrittenMessage> small_log(test::Wire wire) {
  const auto start = [&](test::MessageWriter& writer) -> test::MessageWriter& {
    return writer.header(1700000000000000000, "f").number(uint32_t{3}).number(uint32_t{4});
  };
  test::MessageWriter info(wire), colour(wire), depth(wire);
  start(info).text("plumb_bob").number(uint32_t{0}).doubles({4, 0, 2, 0, 4, 1, 0, 0, 1});
  info.doubles(std::vector<double>(9)).doubles(std::vector<double>(12));
  start(colour).text("rgb8").number(uint8_t{0}).number(uint32_t{12}).data(std::string(36, 'c'));
  start(depth).text("16UC1").number(uint8_t{0}).number(uint32_t{8}).data(std::string(24, 'd'));
  return {{"/color/camera_info", "sensor_msgs/CameraInfo", 1, info.bytes()},
          {"/color/image_raw", "sensor_msgs/Image", 2, colour.bytes()},
          {"/depth/image_raw", "sensor_msgs/Image", 3, depth.bytes()}};
}

void write_logs(const std::filesystem::path& root) {
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(root / name, std::ios::binary) << bytes;
  };
  const auto ros2 = small_log(test::Wire::Cdr), ros1 = small_log(test::Wire::Ros1);
  for (const char* packing : {"", "lz4", "zstd"}) {
    write(std::string("mcap/index_") + packing, test::mcap_of(ros2, {.packing = packing}));
    write(std::string("mcap/cut_") + packing, test::mcap_of(ros2, {.packing = packing, .index = false}));
  }
  for (const char* packing : {"none", "lz4", "bz2"}) {
    write(std::string("bag/index_") + packing, test::bag_of(ros1, {.packing = packing}));
    write(std::string("bag/cut_") + packing, test::bag_of(ros1, {.packing = packing, .index = false}));
  }
  test::write_db3(root / "db3/bag", ros2);
  for (std::size_t i = 0; i < ros2.size(); ++i) {
    write("messages/cdr" + std::to_string(i), std::string(1, '\0') + ros2[i].bytes);
    write("messages/ros1_" + std::to_string(i), std::string(1, '\1') + ros1[i].bytes);
  }
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
  for (const char* reader : {"map_ply", "map_spz", "mesh", "colour", "depth", "tiff", "mcap", "bag", "db3",
                             "messages", "frame_stream"})
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
  write_logs(root);
  std::ofstream(root / "frame_stream/stream", std::ios::binary)
      << small_stream(root / "colour/png", root / "depth/png");
  std::ofstream(root / "made") << "";
}
