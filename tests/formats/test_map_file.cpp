#include "engine/formats/map_file.h"

#include <sys/stat.h>

#include "engine/formats/gaussian_order.h"
#include "engine/formats/ply_header.h"
#include "engine/formats/ply_records.h"
#include "engine/io/files.h"
#include "tests/formats/clouds.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::random_cloud;
using test::TemporaryFolder;

TEST_CASE("maps are read in the format of their content and written in that of their name") {
  const TemporaryFolder folder;
  const GaussianCloud cloud = random_cloud(5, 2);
  for (const char* name : {"map.ply", "map.spz", "map.compressed.ply"}) {
    write_map(folder / name, cloud);
    CHECK(read_map(folder / name).cloud.size() == 5);
    std::filesystem::rename(folder / name, folder / "map.unknown");
    CHECK(read_map(folder / "map.unknown").cloud.sh_degree == 2);
  }
  write_map(folder / "map.glb", cloud);
  CHECK(read_file(folder / "map.glb").starts_with("glTF"));
  CHECK(contains(input_error([&] { write_map(folder / "map.png", cloud); }),
                 "map.png: has no ending of a map format; name it .ply, .compressed.ply, .spz or .glb"));
  CHECK(contains(input_error([&] { read_map(folder / "map.glb"); }),
                 "map.glb: is a glTF file, which is written but not read here"));
  CHECK(contains(input_error([&] { read_map(folder.write("a.spz", "hello")); }), "is no SPZ file"));
  CHECK(contains(input_error([&] { read_map(folder.write("a.ply", "hello")); }), "is no PLY file"));
  CHECK(contains(input_error([&] { read_map(folder / "none.ply"); }), "no such file"));
}

TEST_CASE("what has no place for the sampling of Gaussians gets them a little wider") {
  const TemporaryFolder folder;
  GaussianCloud cloud = random_cloud(2, 0);
  cloud.log_scales.assign(2, Eigen::Vector3f::Constant(std::log(0.01f)));
  cloud.sampling = {0.02f, 0};
  write_map(folder / "map.ply", cloud);
  CHECK(read_map(folder / "map.ply").cloud.log_scales == cloud.log_scales);
  write_map(folder / "map.spz", cloud);
  const GaussianCloud read = read_map(folder / "map.spz").cloud;
  CHECK(std::exp(2 * read.log_scales[0].x()) ==
        doctest::Approx(0.01 * 0.01 + 0.1 * 0.02 * 0.02).epsilon(0.08));
  CHECK(std::exp(read.log_scales[1].x()) == doctest::Approx(0.01).epsilon(0.04));
  CHECK(read.sampling == std::vector<float>{0, 0});
}

namespace {

std::string bytes_of(const std::vector<float>& values) {
  return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
}

/// Gaussians as in a .splat file.
std::string splat_records(int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i)
    bytes += bytes_of({0.5f * static_cast<float>(i), -1, 2, 0.01f, 0.02f, 0.03f}) +
             "\xff\x80\x40\xff\xff\x80\x80\x80";
  return bytes;
}

/// The headers of a .ksplat file with one section of 7 splats.
std::string ksplat_headers() {
  std::string bytes(4096 + 1024, '\0');
  bytes[1] = 1;
  for (std::size_t at : {4, 8}) bytes[at] = 1;
  for (std::size_t at : {12, 16}) bytes[at] = 7;
  return bytes;
}

/// The start of a zip archive whose first file has this name.
std::string zip_with(const std::string& name) {
  return "PK\x03\x04" + std::string(22, '\1') + std::string(4, '\0') + name + "content";
}

}  // namespace

TEST_CASE("maps in formats that are not read are named by their content, with a way to convert them") {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& name, const std::string& content) {
    return input_error([&] { read_map(folder.write(name, content)); });
  };
  for (const char* name : {"a.splat", "a.bin", "a.ply"}) {
    const std::string message = error(name, splat_records(3));
    CHECK(contains(message, std::string(name) + ": is a map in the format .splat"));
    CHECK(contains(message, "convert it to PLY"));
  }
  for (const char* name : {"a.ksplat", "a.bin"})
    CHECK(contains(error(name, ksplat_headers()), "is a map in the format .ksplat"));
  CHECK(contains(error("a.sog", "?"), "SOG"));
  CHECK(contains(error("a.zip", zip_with("meta.json") + zip_with("means_l.webp")), "SOG"));
  CHECK(contains(error("meta.json", R"({"means": {"files": ["means_l.webp"]}})"), "SOG"));
  CHECK(contains(error("params.npz", zip_with("means3D.npy")), "NumPy"));
  CHECK(contains(error("a.bin", "\x93NUMPY\1"), "NumPy"));
  CHECK(contains(error("a.pth", zip_with("model/data.pkl")), "PyTorch"));
  CHECK(contains(error("a.zip", zip_with("map.ply")), "is a zip archive; unpack it"));
  CHECK(contains(error("a.bin", std::string("glTF\2\0\0\0", 8)), "is a glTF file"));
  CHECK(contains(error("a.ksplat", "short"), ".ksplat"));
  CHECK(contains(error("notes.txt", "some text that is no map at all"), "is no PLY file"));
  CHECK(contains(input_error([&] { read_map(folder.path()); }), "is a folder; give the file of a map"));
}

TEST_CASE("a pipe is no map, and nobody waits for it") {
  const TemporaryFolder folder;
  REQUIRE(mkfifo((folder / "map.ply").c_str(), 0600) == 0);
  CHECK(contains(input_error([&] { read_map(folder / "map.ply"); }), "is no file that can be read as a map"));
}

TEST_CASE("a map of which nothing is left is refused, and what is left out is counted") {
  const TemporaryFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  GaussianCloud cloud = random_cloud(5, 0);
  for (std::size_t i : {0, 1, 2}) cloud.opacity_logits[i] = -infinity;
  cloud.means[3].x() = infinity;
  write_map(folder / "map.ply", cloud);
  const MapFile map = read_map(folder / "map.ply");
  CHECK(map.cloud.size() == 1);
  CHECK(map.dropped == 1);
  CHECK(map.invisible == 3);
  CHECK(left_out_text(1, 3) == "1 hold NaN or infinite values or no rotation, 3 have opacity 0 (-inf)");
  cloud.rotations[4].setZero();
  write_map(folder / "map.ply", cloud);
  CHECK(contains(input_error([&] { read_map(folder / "map.ply"); }), "none of its 5 Gaussians can be used"));
  write_map(folder / "map.ply", {});
  CHECK(read_map(folder / "map.ply").cloud.size() == 0);
}

TEST_CASE("a point cloud has the centres, colours and opacities of the Gaussians that are finite") {
  const TemporaryFolder folder;
  GaussianCloud cloud = random_cloud(4, 1);
  cloud.sh[0] = -1;                                   // red 0.218
  cloud.sh[1] = 9;                                    // green beyond white
  cloud.sh[2] = -9;                                   // blue below black
  cloud.opacity_logits[3] = std::log(0.25f / 0.75f);  // a quarter
  cloud.means[1].z() = std::numeric_limits<float>::infinity();
  write_map(folder / "points.ply", cloud, MapFormat::Points);
  const std::filesystem::path file = folder / "points.ply";
  const PlyHeader header = read_ply_header(file);
  REQUIRE(header.vertices().count == 3);
  PlyRecordReader reader(file, header);
  PlyRecord record;
  reader.next(header.vertices(), record);
  CHECK(record.values[0] == cloud.means[0].x());
  CHECK(record.values[2] == cloud.means[0].z());
  CHECK(std::vector<double>(record.values.begin() + 3, record.values.begin() + 6) ==
        std::vector<double>{56, 255, 0});
  reader.next(header.vertices(), record);
  CHECK(record.values[1] == cloud.means[2].y());
  reader.next(header.vertices(), record);
  CHECK(record.values[6] == doctest::Approx(0.25));
  CHECK(header.vertices().properties[6].name == "opacity");
  write_map(file, {}, MapFormat::Points);
  CHECK(read_ply_header(file).vertices().count == 0);
}

TEST_CASE("along the Morton curve, x goes before y and y before z, and nothing is lost") {
  GaussianCloud cloud;
  cloud.resize(8);
  for (std::size_t i = 0; i < 8; ++i)  // the corners of a box, from the last to the first
    cloud.means[i] = {i & 1 ? 0.0f : 2.0f, i & 2 ? -1.0f : 1.0f, i & 4 ? 5.0f : 7.0f};
  std::vector<std::size_t> order = finite_gaussians(cloud);
  sort_along_morton_curve(cloud, order);
  CHECK(order == std::vector<std::size_t>{7, 6, 5, 4, 3, 2, 1, 0});
  CHECK(select(cloud, order).means[0] == cloud.means[7]);

  const GaussianCloud many = random_cloud(2000, 0);
  order = finite_gaussians(many);
  const auto way = [&] {
    float sum = 0;
    for (std::size_t i = 1; i < order.size(); ++i)
      sum += (many.means[order[i]] - many.means[order[i - 1]]).norm();
    return sum;
  };
  const float before = way();
  sort_along_morton_curve(many, order);
  CHECK(way() < before / 4);
  std::sort(order.begin(), order.end());
  CHECK(order == finite_gaussians(many));
}

TEST_CASE("Gaussians with a value that is not finite, or without a rotation, are told apart") {
  const float infinity = std::numeric_limits<float>::infinity();
  GaussianCloud cloud = random_cloud(7, 1);
  cloud.means[0].x() = infinity;
  cloud.log_scales[1].y() = -infinity;
  cloud.rotations[2].setZero();
  cloud.rotations[3][3] = std::nanf("");
  cloud.opacity_logits[4] = infinity;
  cloud.sh[6 * 12 - 1] = infinity;  // the last of the sixth
  CHECK(finite_gaussians(cloud) == std::vector<std::size_t>{6});
}
