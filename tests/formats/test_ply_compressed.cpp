#include <cstring>
#include <limits>

#include "engine/formats/gaussian_order.h"
#include "engine/formats/ply.h"
#include "engine/formats/triangle_mesh.h"
#include "engine/io/files.h"
#include "tests/formats/clouds.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::compare;
using test::contains;
using test::Differences;
using test::input_error;
using test::opacity;
using test::random_cloud;
using test::TemporaryFolder;

namespace {

/// The cloud in the order in which it is written.
GaussianCloud as_written(const GaussianCloud& cloud) {
  std::vector<std::size_t> order = finite_gaussians(cloud);
  sort_along_morton_curve(cloud, order);
  return select(cloud, order);
}

GaussianCloud round_trip(const TemporaryFolder& folder, const GaussianCloud& cloud) {
  write_compressed_ply(folder / "cloud.compressed.ply", cloud);
  PlyCloud read = read_ply(folder / "cloud.compressed.ply");
  CHECK(read.dropped == 0);
  CHECK(read.cloud.is_consistent());
  return std::move(read.cloud);
}

/// The largest error of vectors in 11, 10 and 11 bits, as a share of half a step between the bounds of the
/// 256 vectors around each. With a margin for 32-bit floats it must not be above 1.
float steps_off(const std::vector<Eigen::Vector3f>& in, const std::vector<Eigen::Vector3f>& out) {
  const Eigen::Array3d steps(2047, 1023, 2047);
  double worst = 0;
  for (std::size_t begin = 0; begin < in.size(); begin += 256) {
    const std::size_t end = std::min(in.size(), begin + 256);
    Eigen::Array3d low = in[begin].cast<double>(), high = low;
    for (std::size_t i = begin; i < end; ++i) {
      low = low.min(in[i].cast<double>().array());
      high = high.max(in[i].cast<double>().array());
    }
    const Eigen::Array3d half = (high - low) / steps / 2 + 1e-6 * low.abs().max(high.abs()) + 1e-30;
    for (std::size_t i = begin; i < end; ++i)
      worst = std::max(worst, ((out[i] - in[i]).cast<double>().array().abs() / half).maxCoeff());
  }
  return static_cast<float>(worst);
}

std::string uint32s(std::initializer_list<uint32_t> values) {
  std::string bytes(values.size() * 4, '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

std::string floats(const std::vector<float>& values) {
  std::string bytes(values.size() * 4, '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// One Gaussian of SH degree 1, as the format's description has it.
std::string by_hand() {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment by hand\nelement chunk 1\n";
  for (const char* kind : {"_x", "_y", "_z"}) text += std::string("property float min") + kind + "\n";
  for (const char* kind : {"_x", "_y", "_z"}) text += std::string("property float max") + kind + "\n";
  for (const char* kind : {"_x", "_y", "_z"}) text += std::string("property float min_scale") + kind + "\n";
  for (const char* kind : {"_x", "_y", "_z"}) text += std::string("property float max_scale") + kind + "\n";
  text += "element vertex 1\n";
  for (const char* kind : {"position", "rotation", "scale", "color"})
    text += std::string("property uint packed_") + kind + "\n";
  text += "element sh 1\n";
  for (int k = 0; k < 9; ++k) text += "property uchar f_rest_" + std::to_string(k) + "\n";
  text += "end_header\n";
  text += floats({0, 10, 20, 2047, 1033, 2067, -6, -6, -6, -4, -4, -4});
  text += uint32s({3u << 21 | 1023u << 11 | 7u, 0x40000000u | 1023u << 20 | 512u << 10 | 512u,
                   2047u << 21 | 0u << 11 | 2047u, 0xff800033u});
  const unsigned char harmonics[] = {0, 128, 255, 1, 2, 3, 4, 5, 6};
  return text + std::string(reinterpret_cast<const char*>(harmonics), sizeof(harmonics));
}

std::string read_error(const TemporaryFolder& folder, const std::string& content) {
  return input_error([&] { read_ply(folder.write("cloud.ply", content)); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("clouds of every size and SH degree survive compressed PLY within its rounding") {
  const TemporaryFolder folder;
  for (std::size_t count : {0, 1, 255, 256, 257, 2000})
    for (int degree = 0; degree <= 3; ++degree) {
      CAPTURE(count);
      CAPTURE(degree);
      const GaussianCloud cloud = as_written(random_cloud(count, degree));
      const GaussianCloud read = round_trip(folder, random_cloud(count, degree));
      REQUIRE(read.size() == count);
      REQUIRE(read.sh_degree == degree);
      if (count == 0) continue;
      CHECK(steps_off(cloud.means, read.means) <= 1);
      CHECK(steps_off(cloud.log_scales, read.log_scales) <= 1);
      const Differences d = compare(cloud, read);
      CHECK(d.shape < 0.0136f);  // 0.28 degrees, where all four numbers are equal
      CHECK(d.opacity <= 1.01f / 510);
      CHECK(d.colour <= 1.01f * 1.98f / 510);  // of 256 colours from -0.99 to 0.99
      CHECK(d.degree_1 <= 1.01f / 64);
      CHECK(d.above <= 1.01f / 64);
    }
}

TEST_CASE("extreme Gaussians survive compressed PLY: tiny, huge, clear, opaque, all in one place") {
  const TemporaryFolder folder;
  GaussianCloud cloud = random_cloud(300, 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.means[i] = {1, -2, 3};
    cloud.log_scales[i] = {i % 2 ? -100.0f : 100.0f, -3, 19};
    cloud.opacity_logits[i] = i % 2 ? 40.0f : -40.0f;
    cloud.sh[3 * i] = i % 2 ? 1000.0f : -1000.0f;
  }
  GaussianCloud read = round_trip(folder, cloud);
  REQUIRE(read.size() == 300);
  for (std::size_t i = 0; i < read.size(); ++i) {
    CHECK(read.means[i] == Eigen::Vector3f(1, -2, 3));
    CHECK(std::abs(read.log_scales[i].x()) == 20);
    CHECK(read.log_scales[i].y() == -3);
    CHECK(opacity(read.opacity_logits[i]) == doctest::Approx(i % 2 ? 254.75 / 255 : 0.25 / 255));
    CHECK(read.sh[3 * i] == doctest::Approx(i % 2 ? 1000 : -1000));
  }
  cloud = random_cloud(2, 0);
  cloud.means = {{-3e38f, 0, 0}, {3e38f, 1e-30f, 0}};
  read = round_trip(folder, cloud);
  CHECK(steps_off(as_written(cloud).means, read.means) <= 1);
}

TEST_CASE("each rotation survives compressed PLY, whichever of its numbers is the largest") {
  const TemporaryFolder folder;
  GaussianCloud cloud;
  cloud.resize(8);
  for (std::size_t i = 0; i < 8; ++i) {
    cloud.means[i].x() = static_cast<float>(i);  // keeps the order
    cloud.rotations[i] = {0.1f, -0.2f, 0.3f, -0.4f};
    cloud.rotations[i][static_cast<Eigen::Index>(i / 2)] = i % 2 ? -2.0f : 2.0f;
  }
  const GaussianCloud read = round_trip(folder, cloud);
  for (std::size_t i = 0; i < 8; ++i) {
    const Eigen::Vector4f q = cloud.rotations[i].normalized();
    CHECK(std::abs(q.dot(read.rotations[i])) > 1 - 2e-6f);
    CHECK(read.rotations[i].norm() == doctest::Approx(1));
  }
}

TEST_CASE("a compressed PLY file made by hand is read as its format says") {
  const TemporaryFolder folder;
  const GaussianCloud cloud = read_ply(folder.write("a.ply", by_hand())).cloud;
  REQUIRE(cloud.size() == 1);
  CHECK(cloud.means[0].isApprox(Eigen::Vector3f(3, 1033, 27)));
  CHECK(cloud.log_scales[0].isApprox(Eigen::Vector3f(-4, -6, -4)));
  // x is the largest; w at its highest, 1/sqrt(2), y and z nearly zero.
  const float half = std::sqrt(0.5f);
  CHECK(cloud.rotations[0].isApprox(Eigen::Vector4f(half, half, 0.00069f, 0.00069f), 1e-4f));
  CHECK(cloud.sh[0] * 0.28209479f == doctest::Approx(0.5));
  CHECK(cloud.sh[1] * 0.28209479f == doctest::Approx(128.0 / 255 - 0.5));
  CHECK(cloud.sh[2] * 0.28209479f == doctest::Approx(-0.5));
  CHECK(opacity(cloud.opacity_logits[0]) == doctest::Approx(51.0 / 255));
  // Red coefficients come first: -4, 1/64, 4.
  CHECK(cloud.sh[3] == -4);
  CHECK(cloud.sh[6] == 1.0f / 64);
  CHECK(cloud.sh[9] == 4);
  CHECK(cloud.sh[4] == doctest::Approx((1.5 / 256 - 0.5) * 8));
  CHECK(cloud.sh[5] == doctest::Approx((4.5 / 256 - 0.5) * 8));
}

TEST_CASE("the bytes of a compressed PLY are those that its description asks for") {
  const TemporaryFolder folder;
  GaussianCloud cloud;
  cloud.resize(2);
  cloud.means = {{0, 0, 0}, {1, 2, 4}};
  cloud.log_scales = {{-4, -5, -6}, {-6, -5, -4}};
  cloud.rotations[1] = {0, 0, -1, 0};
  cloud.opacity_logits = {0, std::log(0.25f)};
  cloud.sh = {0, 0, 0, 1, 1, -1};
  write_compressed_ply(folder / "a.ply", cloud);
  const std::string bytes = read_file(folder / "a.ply");
  const uint32_t middle = 512u << 20 | 512u << 10 | 512u;
  CHECK(bytes.ends_with(uint32s({0, middle, 2047u << 21, 255u << 8 | 128u}) +
                        uint32s({0xffffffffu, 2u << 30 | middle, 2047u, 255u << 24 | 255u << 16 | 51u})));
  CHECK(contains(bytes, "element chunk 1\n"));
  CHECK(contains(bytes, floats({0, 0, 0, 1, 2, 4, -6, -5, -6, -4, -5, -4})));
  CHECK_FALSE(contains(bytes, "element sh"));
}

TEST_CASE("compressed PLY leaves out Gaussians that are not finite, and drops those that it reads") {
  const TemporaryFolder folder;
  GaussianCloud cloud = random_cloud(3, 1);
  cloud.means[1].y() = std::numeric_limits<float>::quiet_NaN();
  CHECK(round_trip(folder, cloud).size() == 2);
  std::string bytes = by_hand();
  const std::string bound = floats({2047, 1033});
  bytes = replaced(bytes, bound, floats({std::numeric_limits<float>::infinity(), 1033}));
  const PlyCloud read = read_ply(folder.write("a.ply", bytes));
  CHECK(read.cloud.size() == 0);
  CHECK(read.dropped == 1);
}

TEST_CASE("foreign compressed PLY files are refused with the reason") {
  const TemporaryFolder folder;
  const std::string good = by_hand();
  CHECK(read_error(folder, good).empty());
  const auto changed = [&](const char* from, const char* to) {
    return read_error(folder, replaced(good, from, to));
  };
  CHECK(contains(changed("element vertex 1", "element vertex 9"), "cloud.ply: holds fewer vertices"));
  CHECK(contains(changed("element chunk 1", "element chunk 99999999999999"), "holds fewer chunks than"));
  CHECK(contains(changed("element chunk 1", "element chunk 0"), "need more than its 0 chunks"));
  CHECK(contains(changed("element sh 1", "element sh 0"), "coefficients of 0"));
  CHECK(contains(changed("element vertex", "element face"), "the first element must be vertex"));
  CHECK(contains(changed("float min_y", "float mid_y"),
                 "element chunk has no property min_y of the type float"));
  CHECK(contains(changed("uint packed_scale", "int packed_scale"),
                 "no property packed_scale of the type uint"));
  CHECK(contains(changed("uchar f_rest_8", "char f_rest_8"), "no property f_rest_8 of the type uchar"));
  CHECK(contains(changed("property uchar f_rest_8\n", ""), "has 8 SH coefficients"));
  CHECK(contains(
      read_error(folder, "ply\nformat ascii 1.0\nelement chunk 1\nproperty float min_x\nend_header\n1\n"),
      "has no element vertex"));
  CHECK(contains(input_error([&] { read_mesh(folder.write("a.ply", good)); }), "no triangle mesh"));
  CHECK(contains(input_error([&] { write_compressed_ply(folder / "no/a.ply", {}); }), "create it first"));
}

TEST_CASE("a compressed PLY cut at any byte, or with any byte changed, is read or refused, never a crash") {
  const TemporaryFolder folder;
  write_compressed_ply(folder / "full.ply", random_cloud(3, 1));
  const std::string full = read_file(folder / "full.ply");
  for (std::size_t length = 0; length < full.size(); ++length)
    CHECK_FALSE(read_error(folder, full.substr(0, length)).empty());
  for (std::size_t i = 0; i < full.size(); ++i) {
    std::string bytes = full;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x15);
    const std::string message = read_error(folder, bytes);
    CHECK((message.empty() || contains(message, "cloud.ply")));
  }
}
