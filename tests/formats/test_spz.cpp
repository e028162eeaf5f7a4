#include "engine/formats/spz.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "engine/formats/map_file.h"
#include "engine/formats/ply.h"
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

std::string gzipped(const std::string& bytes) {
  z_stream z{};
  deflateInit2(&z, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(bytes.size() + 100, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  REQUIRE(deflate(&z, Z_FINISH) == Z_STREAM_END);
  out.resize(out.size() - z.avail_out);
  deflateEnd(&z);
  return out;
}

std::string gunzipped(const std::string& bytes) {
  z_stream z{};
  inflateInit2(&z, MAX_WBITS + 16);
  std::string out(100000, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  REQUIRE(inflate(&z, Z_FINISH) == Z_STREAM_END);
  out.resize(out.size() - z.avail_out);
  inflateEnd(&z);
  return out;
}

std::string bytes_of(std::initializer_list<int> values) {
  std::string bytes;
  for (int value : values) bytes.push_back(static_cast<char>(value));
  return bytes;
}

/// One Gaussian of SH degree 1 as the format's description has it, at (1, -2, 0.5) in the file's axes.
std::string header_by_hand(int version) {
  return "NGSP" + bytes_of({version, 0, 0, 0, 1, 0, 0, 0, 1, 12, 0, 0});
}
const std::string kBeforeRotation =
    bytes_of({0x00, 0x10, 0x00, 0x00, 0xe0, 0xff, 0x00, 0x08, 0x00}) +  // position
    bytes_of({51, 255, 0, 128, 160, 144, 176});                         // alpha, colour, scales
const std::string kHarmonics = bytes_of({192, 128, 128, 128, 64, 128, 128, 128, 160});

std::string read_error(const TemporaryFolder& folder, const std::string& content) {
  return input_error([&] { read_spz(folder.write("cloud.spz", content)); });
}

}  // namespace

TEST_CASE("clouds of every SH degree survive SPZ within its rounding") {
  const TemporaryFolder folder;
  for (int degree = 0; degree <= 3; ++degree) {
    const GaussianCloud cloud = random_cloud(500, degree);
    write_spz(folder / "a.spz", cloud);
    const GaussianCloud read = read_spz(folder / "a.spz");
    REQUIRE(read.sh_degree == degree);
    REQUIRE(read.size() == 500);
    REQUIRE(read.is_consistent());
    const Differences d = compare(cloud, read);
    CHECK(d.mean <= 1.01f / 8192);
    CHECK(d.log_scale <= 1.01f / 32);
    CHECK(d.shape < 0.12f);
    CHECK(d.opacity <= 1.01f / 510);
    CHECK(d.colour <= 1.01f / 510 / 0.15f);
    CHECK(d.degree_1 <= 1.01f / 32);
    CHECK(d.above <= 1.01f / 16);
    CHECK_FALSE(std::filesystem::exists(folder / "a.spz.part"));
  }
}

TEST_CASE("SPZ holds no Gaussian, one, and many, and is the same file each time") {
  const TemporaryFolder folder;
  for (std::size_t count : {0, 1, 20000}) {
    const GaussianCloud cloud = random_cloud(count, 0);
    write_spz(folder / "a.spz", cloud);
    write_spz(folder / "b.spz", cloud);
    CHECK(read_file(folder / "a.spz") == read_file(folder / "b.spz"));
    const GaussianCloud read = read_spz(folder / "a.spz");
    REQUIRE(read.size() == count);
    CHECK(compare(cloud, read).mean <= 1.01f / 8192);
  }
  CHECK(std::filesystem::file_size(folder / "a.spz") < 20000 * 19 + 100);
}

TEST_CASE("what is rounded once is not rounded again") {
  const TemporaryFolder folder;
  write_spz(folder / "a.spz", random_cloud(300, 3));
  const GaussianCloud once = read_spz(folder / "a.spz");
  write_spz(folder / "b.spz", once);
  const Differences d = compare(once, read_spz(folder / "b.spz"));
  CHECK(d.mean == 0);
  CHECK(d.log_scale == 0);
  CHECK(d.opacity < 1e-5f);
  CHECK(d.colour < 1e-5f);
  CHECK(d.degree_1 == 0);
  CHECK(d.above == 0);
}

TEST_CASE("an SPZ file made by hand is read as its format says, with the axes turned") {
  const TemporaryFolder folder;
  const std::string version_2 = header_by_hand(2) + kBeforeRotation + bytes_of({128, 255, 128}) + kHarmonics;
  const GaussianCloud cloud = read_spz(folder.write("a.spz", gzipped(version_2)));
  REQUIRE(cloud.size() == 1);
  CHECK(cloud.means[0] == Eigen::Vector3f(1, 2, -0.5f));
  CHECK(opacity(cloud.opacity_logits[0]) == doctest::Approx(0.2));
  CHECK(cloud.log_scales[0] == Eigen::Vector3f(0, -1, 1));
  CHECK(cloud.sh[0] == doctest::Approx(0.5 / 0.15));
  CHECK(cloud.sh[1] == doctest::Approx(-0.5 / 0.15));
  // Degree 1 is y, z, x: the first two turn, the third stays. Channels are innermost.
  CHECK(std::vector<float>(cloud.sh.begin() + 3, cloud.sh.end()) ==
        std::vector<float>{-0.5f, 0, 0, 0, 0.5f, 0, 0, 0, 0.25f});
  // A turn by 180 degrees about y in the file's axes is one about -y in ours.
  CHECK(cloud.rotations[0].isApprox(Eigen::Vector4f(0, 0.0039f, -1, -0.0039f), 1e-3f));
}

TEST_CASE("rotations of SPZ version 3 are read: three of four, ten bits each, and which is missing") {
  const TemporaryFolder folder;
  const auto rotation = [&](uint32_t packed) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &packed, 4);
    return read_spz(folder.write("a.spz", gzipped(header_by_hand(3) + kBeforeRotation + bytes + kHarmonics)))
        .rotations[0];
  };
  const float half = std::sqrt(0.5f);
  // w missing: x, y, z from the high bits to the low ones.
  CHECK(rotation(3u << 30 | 511u << 20).isApprox(Eigen::Vector4f(half, half, 0, 0), 1e-5f));
  CHECK(rotation(3u << 30 | 511u << 10).isApprox(Eigen::Vector4f(half, 0, -half, 0), 1e-5f));
  CHECK(rotation(3u << 30 | (512u | 511u)).isApprox(Eigen::Vector4f(half, 0, 0, half), 1e-5f));
  // x missing: y, z, w.
  CHECK(rotation(511u).isApprox(Eigen::Vector4f(half, half, 0, 0), 1e-5f));
  CHECK(rotation(0).isApprox(Eigen::Vector4f(0, 1, 0, 0)));
  // y missing: x, z, w.
  CHECK(rotation(1u << 30 | 511u << 20).isApprox(Eigen::Vector4f(0, half, -half, 0), 1e-5f));
}

TEST_CASE("the bytes written are those that the format's description asks for") {
  const TemporaryFolder folder;
  GaussianCloud cloud;
  cloud.sh_degree = 1;
  cloud.resize(1);
  cloud.means[0] = {1, 2, -0.5f};
  cloud.log_scales[0] = {0, -1, 1};
  cloud.opacity_logits[0] = std::log(0.25f);
  cloud.sh = {0.5f / 0.15f, -0.5f / 0.15f, 0.5f / 255 / 0.15f, -0.5f, 0, 0, 0, 0.5f, 0, 0, 0, 0.25f};
  write_spz(folder / "a.spz", cloud);
  CHECK(gunzipped(read_file(folder / "a.spz")) ==
        header_by_hand(2) + kBeforeRotation + bytes_of({128, 128, 128}) + kHarmonics);
  // A turn about z by 2 atan(1/2): w 0.894, z 0.447, which is turned with the axes.
  cloud.rotations[0] = {2, 0, 0, 1};
  write_spz(folder / "a.spz", cloud);
  CHECK(gunzipped(read_file(folder / "a.spz")).substr(32, 3) == bytes_of({128, 128, 70}));
}

TEST_CASE("values that SPZ cannot hold are clamped, large maps rounded more, wrong Gaussians invisible") {
  const TemporaryFolder folder;
  GaussianCloud cloud = random_cloud(4, 0);
  cloud.means[0] = {100000, -5, 7};
  cloud.log_scales[0] = {-20, 9, 0};
  cloud.opacity_logits[0] = 40;
  cloud.opacity_logits[1] = -40;
  cloud.sh[0] = 50;
  cloud.means[2].y() = std::numeric_limits<float>::quiet_NaN();
  cloud.log_scales[3].z() = std::numeric_limits<float>::infinity();
  write_spz(folder / "a.spz", cloud);
  const GaussianCloud read = read_spz(folder / "a.spz");
  CHECK((read.means[0] - cloud.means[0]).cwiseAbs().maxCoeff() <= 1.0f / 64);
  CHECK(read.log_scales[0].x() == -10);
  CHECK(read.log_scales[0].y() == doctest::Approx(255.0 / 16 - 10));
  CHECK(opacity(read.opacity_logits[0]) == doctest::Approx(254.75 / 255));
  for (std::size_t i : {1, 2, 3}) CHECK(opacity(read.opacity_logits[i]) < 0.002);
  CHECK(read.sh[0] == doctest::Approx(0.5 / 0.15));
  for (const Eigen::Vector3f& mean : read.means) CHECK(mean.allFinite());
  cloud.means[0].x() = 1e7f;
  CHECK(contains(input_error([&] { write_spz(folder / "b.spz", cloud); }), "use the PLY format"));
}

TEST_CASE("foreign SPZ files are refused with the reason") {
  const TemporaryFolder folder;
  const std::string good = header_by_hand(2) + kBeforeRotation + bytes_of({128, 255, 128}) + kHarmonics;
  const auto changed = [&](std::size_t at, int value) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(value);
    return read_error(folder, gzipped(bytes));
  };
  CHECK(read_error(folder, gzipped(good)).empty());
  CHECK(read_error(folder, gzipped(good + "extension")).empty());
  CHECK(contains(read_error(folder, ""), "cloud.spz: is no SPZ file"));
  CHECK(contains(read_error(folder, "ply\nformat"), "is no SPZ file: it is not gzip-compressed"));
  CHECK(contains(read_error(folder, good), "version 4 or later"));
  CHECK(contains(changed(0, 'X'), "\"NGSP\" is missing"));
  CHECK(contains(changed(4, 1), "version 1; only 2 and 3 are read"));
  CHECK(contains(changed(12, 4), "SH of degree 4"));
  CHECK(contains(changed(13, 24), "24 bits after the point"));
  CHECK(contains(changed(11, 200), "holds fewer Gaussians than its header says"));
  CHECK(contains(changed(8, 2), "ends too early"));
  CHECK(contains(input_error([&] { read_spz(folder / "none.spz"); }), "none.spz: no such file"));
  CHECK(contains(input_error([&] { write_spz(folder / "no/a.spz", {}); }), "create it first"));
}

TEST_CASE("an SPZ file that claims far more than its bytes is refused before memory is taken") {
  const TemporaryFolder folder;
  const auto claims = [&](uint32_t count, std::size_t bytes) {
    std::string content = header_by_hand(2);
    std::memcpy(content.data() + 8, &count, 4);
    content[12] = 0;  // SH of degree 0: 19 bytes a Gaussian
    return read_error(folder, gzipped(content + std::string(bytes, '\0')));
  };
  CHECK(claims(1000, 19 * 1000).empty());
  CHECK(contains(claims(20000000, 400000), "holds fewer Gaussians than its header says (20000000)"));
  // The bytes are there, but no real map is all zeros.
  CHECK(contains(claims(2000000, 19 * 2000000), "claims 2000000 Gaussians in "));
  CHECK(contains(claims(1001, 19 * 1000), "ends too early"));
  CHECK(contains(claims(10, 3000000), "goes on far beyond what its header tells of"));
}

TEST_CASE("an SPZ file cut at any byte, or with any byte changed, is read or refused, never a crash") {
  const TemporaryFolder folder;
  write_spz(folder / "full.spz", random_cloud(3, 1));
  const std::string full = read_file(folder / "full.spz");
  for (std::size_t length = 0; length < full.size(); ++length)
    CHECK_FALSE(read_error(folder, full.substr(0, length)).empty());
  int refused = 0;
  for (std::size_t i = 0; i < full.size(); ++i) {
    std::string changed = full;
    changed[i] = static_cast<char>(changed[i] ^ 0x15);
    const std::string message = read_error(folder, changed);
    CHECK((message.empty() || contains(message, "cloud.spz")));
    refused += message.empty() ? 0 : 1;
  }
  CHECK(refused > static_cast<int>(full.size()) - 10);  // all but gzip's time stamp and the like
}
