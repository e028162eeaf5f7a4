#include "engine/formats/ply.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "engine/io/files.h"
#include "tests/formats/clouds.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::random_cloud;
using test::TemporaryFolder;

namespace {

bool equal(const GaussianCloud& a, const GaussianCloud& b) {
  return a.sh_degree == b.sh_degree && a.means == b.means && a.log_scales == b.log_scales &&
         a.rotations == b.rotations && a.opacity_logits == b.opacity_logits && a.sh == b.sh &&
         a.uncertainty == b.uncertainty && a.sampling == b.sampling;
}

constexpr const char* kAsciiHeader =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 2\n"
    "property double opacity\nproperty float rot_0\nproperty float rot_1\nproperty float rot_2\n"
    "property float rot_3\nproperty uchar label\nproperty float z\nproperty float y\nproperty float x\n"
    "property float f_dc_2\nproperty float f_dc_1\nproperty float f_dc_0\n"
    "property float scale_0\nproperty float scale_1\nproperty float scale_2\n"
    "element face 0\nproperty list uchar int vertex_indices\nend_header\n";

std::string read_error(const TemporaryFolder& folder, const std::string& content) {
  return input_error([&] { read_ply(folder.write("cloud.ply", content)); });
}

/// `text` with the first `from` replaced by `to`.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("clouds of every SH degree survive, bit by bit") {
  const TemporaryFolder folder;
  for (int degree = 0; degree <= 3; ++degree) {
    const GaussianCloud cloud = random_cloud(100, degree);
    write_ply(folder / "a.ply", cloud);
    const PlyCloud read = read_ply(folder / "a.ply");
    CHECK(read.dropped == 0);
    CHECK(equal(read.cloud, cloud));
    CHECK_FALSE(std::filesystem::exists(folder / "a.ply.part"));
  }
  write_ply(folder / "empty.ply", GaussianCloud());
  CHECK(read_ply(folder / "empty.ply").cloud.size() == 0);
}

TEST_CASE("the layout on disk is the usual one: f_rest is channel-major, floats in the usual order") {
  const TemporaryFolder folder;
  GaussianCloud cloud = random_cloud(1, 1);
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      cloud.sh[k * 3 + channel] = static_cast<float>(10 * channel + k);
    }
  }
  write_ply(folder / "a.ply", cloud);
  const std::string bytes = read_file(folder / "a.ply");
  const std::string end = "end_header\n";
  const std::size_t data = bytes.find(end) + end.size();
  std::vector<float> values((bytes.size() - data) / sizeof(float));
  std::memcpy(values.data(), bytes.data() + data, values.size() * sizeof(float));
  REQUIRE(values.size() == 3 + 3 + 3 + 9 + 1 + 3 + 4 + 2);
  CHECK(values[0] == cloud.means[0].x());
  CHECK(std::vector<float>(values.begin() + 3, values.begin() + 18) ==
        std::vector<float>{0, 0, 0, 0, 10, 20, 1, 2, 3, 11, 12, 13, 21, 22, 23});
  CHECK(values[18] == cloud.opacity_logits[0]);
  CHECK(values[19] == cloud.log_scales[0].x());
  CHECK(values[22] == cloud.rotations[0].x());
  CHECK(values[26] == cloud.uncertainty[0]);
  CHECK(values[27] == cloud.sampling[0]);
  CHECK(contains(bytes.substr(0, data),
                 "property float rot_3\nproperty float uncertainty\nproperty float sampling\nend_header\n"));
  CHECK(bytes.substr(0, 36) == "ply\nformat binary_little_endian 1.0\n");
}

TEST_CASE("properties may come in any order and type, others are ignored, ASCII is read") {
  const TemporaryFolder folder;
  const auto file = folder.write("a.ply", std::string(kAsciiHeader) +
                                              "-0.5 1 0 0 0 200 3 2 1 0.3 0.2 0.1 -4 -5 -6\n"
                                              "0.5 0 0 0 2 0 6 5 4 0.6 0.5 0.4 -1 -2 -3\r\n");
  const PlyCloud read = read_ply(file);
  REQUIRE(read.cloud.size() == 2);
  CHECK(read.cloud.means[0] == Eigen::Vector3f(1, 2, 3));
  CHECK(read.cloud.rotations[1] == Eigen::Vector4f(0, 0, 0, 2));
  CHECK(read.cloud.opacity_logits[0] == -0.5f);
  CHECK(read.cloud.log_scales[1] == Eigen::Vector3f(-1, -2, -3));
  CHECK(read.cloud.sh == std::vector<float>{0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f});
  CHECK(read.cloud.uncertainty == std::vector<float>{0, 0});  // the file has none
  CHECK(read.cloud.sampling == std::vector<float>{0, 0});
}

TEST_CASE(
    "Gaussians with NaN, an infinite place, size or colour, or a zero rotation are left out and counted") {
  const TemporaryFolder folder;
  GaussianCloud cloud = random_cloud(10, 2);
  cloud.means[1].x() = std::numeric_limits<float>::quiet_NaN();
  cloud.sh[27 * 4 + 20] = std::numeric_limits<float>::infinity();
  cloud.rotations[9].setZero();
  cloud.uncertainty[3] = std::numeric_limits<float>::quiet_NaN();
  cloud.log_scales[5].z() = std::numeric_limits<float>::infinity();
  cloud.opacity_logits[6] = std::numeric_limits<float>::quiet_NaN();
  write_ply(folder / "a.ply", cloud);
  const PlyCloud read = read_ply(folder / "a.ply");
  CHECK(read.dropped == 6);
  CHECK(read.invisible == 0);
  REQUIRE(read.cloud.size() == 4);
  CHECK(read.cloud.means[1] == cloud.means[2]);
  CHECK(read.cloud.sh.size() == 4 * 27);
}

TEST_CASE("infinities have their meaning: opaque, not there, flat, as uncertain as can be") {
  const TemporaryFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  GaussianCloud cloud = random_cloud(6, 1);
  cloud.opacity_logits[0] = infinity;
  cloud.opacity_logits[1] = -infinity;
  cloud.log_scales[2].y() = -infinity;
  cloud.uncertainty[3] = infinity;
  cloud.opacity_logits[4] = infinity;  // of a Gaussian that is flat, too
  cloud.log_scales[4].setConstant(-infinity);
  write_ply(folder / "a.ply", cloud);
  const PlyCloud read = read_ply(folder / "a.ply");
  CHECK(read.dropped == 0);
  CHECK(read.invisible == 1);
  REQUIRE(read.cloud.size() == 5);
  CHECK(test::opacity(read.cloud.opacity_logits[0]) == 1.0f);
  CHECK(std::isfinite(read.cloud.opacity_logits[0]));
  CHECK(read.cloud.means[1] == cloud.means[2]);
  CHECK(std::exp(read.cloud.log_scales[1].y()) < 1e-8f);
  CHECK(read.cloud.log_scales[1].allFinite());
  CHECK(read.cloud.log_scales[1].x() == cloud.log_scales[2].x());
  CHECK(read.cloud.uncertainty[2] > 1e38f);
  CHECK(std::isfinite(read.cloud.uncertainty[2]));
  const auto ascii = folder.write("b.ply", std::string(kAsciiHeader) +
                                               "inf 1 0 0 0 200 3 2 1 0.3 0.2 0.1 -4 -inf -6\n"
                                               "-inf 0 0 0 2 0 6 5 4 0.6 0.5 0.4 -1 -2 -3\n");
  CHECK(read_ply(ascii).cloud.size() == 1);
  CHECK(read_ply(ascii).invisible == 1);
}

TEST_CASE("meshes and point clouds are told from maps of Gaussians") {
  const TemporaryFolder folder;
  const std::string points =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty float opacity\n";
  CHECK(contains(read_error(folder, points + "end_header\n0 0 0 1\n"), "is a point cloud without Gaussians"));
  CHECK(contains(
      read_error(folder, points + "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                  "0 0 0 1\n3 0 0 0\n"),
      "is a triangle mesh (1 faces), not a map of Gaussians; surefield export --mesh"));
}

TEST_CASE("wrong files are refused with the reason") {
  const TemporaryFolder folder;
  const std::string data =
      "-0.5 1 0 0 0 200 3 2 1 0.3 0.2 0.1 -4 -5 -6\n0.5 0 0 0 2 0 6 5 4 0.6 0.5 0.4 -1 -2 -3\n";
  const std::string good = kAsciiHeader + data;
  CHECK(read_error(folder, good).empty());
  CHECK(contains(read_error(folder, "hello"), "is no PLY file"));
  CHECK(contains(read_error(folder, ""), "is no PLY file"));
  CHECK(
      contains(read_error(folder, replaced(good, "ascii", "binary_big_endian")), "cloud.ply:2: the format"));
  CHECK(contains(read_error(folder, replaced(good, "format ascii 1.0\n", "")), "names no format"));
  CHECK(contains(read_error(folder, replaced(good, "element vertex", "element face")),
                 "first element must be vertex"));
  CHECK(contains(read_error(folder, replaced(good, "vertex 2", "vertex -2")), "no number of records"));
  CHECK(contains(read_error(folder, replaced(good, "vertex 2", "vertex 3")), "(3); the file is cut off"));
  CHECK(
      contains(read_error(folder, replaced(good, "vertex 2", "vertex 99999999999")), "holds fewer vertices"));
  CHECK(contains(read_error(folder, replaced(good, "float rot_3", "float other")), "has no property rot_3"));
  CHECK(contains(read_error(folder, replaced(good, "uchar label", "float f_rest_0")),
                 "has 1 properties f_rest_*"));
  CHECK(contains(read_error(folder, replaced(good, "uchar label", "list uchar int label")), "type \"list\""));
  CHECK(contains(read_error(folder, replaced(good, "\n0.5 0", " 0.5\n")), "ends or is damaged"));
  CHECK(contains(read_error(folder, replaced(good, "-0.5 1", "x 1")), "ends or is damaged"));
  CHECK(contains(input_error([&] { read_ply(folder / "none.ply"); }), "none.ply: no such file"));
  CHECK(contains(input_error([&] { write_ply(folder / "no/a.ply", {}); }), "create it first"));
}

TEST_CASE("a cloud cut at any byte, or with any header byte changed, is read or refused, never a crash") {
  const TemporaryFolder folder;
  write_ply(folder / "full.ply", random_cloud(2, 1));
  const std::string full = read_file(folder / "full.ply");
  for (std::size_t length = 0; length < full.size(); ++length) {
    CHECK_FALSE(read_error(folder, full.substr(0, length)).empty());
  }
  const std::size_t header = full.find("end_header");
  for (std::size_t i = 0; i < header + 10; ++i) {
    for (char c : {'\0', '9', '\n'}) {
      std::string changed = full;
      changed[i] = c;
      const std::string message = read_error(folder, changed);
      CHECK((message.empty() || contains(message, "cloud.ply")));
    }
  }
}
