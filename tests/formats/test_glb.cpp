#include "engine/formats/glb.h"

#include <Eigen/Geometry>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/io/files.h"
#include "tests/formats/clouds.h"
#include "tests/reference/spherical_harmonics.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::random_cloud;
using test::TemporaryFolder;

namespace {

/// A binary glTF file, taken apart.
struct Glb {
  nlohmann::json json;
  std::string binary;

  explicit Glb(const std::filesystem::path& file) {
    const std::string bytes = read_file(file);
    const auto number = [&](std::size_t at) {
      uint32_t value = 0;
      std::memcpy(&value, bytes.data() + at, 4);
      return value;
    };
    REQUIRE(bytes.substr(0, 4) == "glTF");
    REQUIRE(number(4) == 2);
    REQUIRE(number(8) == bytes.size());
    REQUIRE(bytes.substr(16, 4) == "JSON");
    REQUIRE(number(12) % 4 == 0);
    json = nlohmann::json::parse(bytes.substr(20, number(12)));
    const std::size_t rest = 20 + number(12);
    if (rest == bytes.size()) return;
    REQUIRE(bytes.substr(rest + 4, 4) == std::string("BIN\0", 4));
    binary = bytes.substr(rest + 8);
    REQUIRE(number(rest) == binary.size());
    REQUIRE(json["buffers"][0]["byteLength"] == binary.size());
  }

  const nlohmann::json& primitive() const { return json["meshes"][0]["primitives"][0]; }

  /// The values of an accessor; checks that it lies within its view and the view within the file.
  template <typename T>
  std::vector<T> values(const nlohmann::json& number, int component_type) const {
    const nlohmann::json& accessor = json["accessors"][number.get<std::size_t>()];
    CHECK(accessor["componentType"] == component_type);
    const std::string type = accessor["type"];
    const std::size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
    const nlohmann::json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::vector<T> read(accessor["count"].get<std::size_t>() * width);
    const std::size_t offset = view["byteOffset"];
    CHECK(view["byteLength"] == read.size() * sizeof(T));
    REQUIRE(offset % 4 == 0);
    REQUIRE(offset + read.size() * sizeof(T) <= binary.size());
    std::memcpy(read.data(), binary.data() + offset, read.size() * sizeof(T));
    return read;
  }
  std::vector<float> floats(const nlohmann::json& number) const { return values<float>(number, 5126); }
  std::vector<uint16_t> shorts(const nlohmann::json& number) const { return values<uint16_t>(number, 5123); }
};

}  // namespace

TEST_CASE("binary glTF holds the Gaussians as KHR_gaussian_splatting has them") {
  const TemporaryFolder folder;
  const GaussianCloud cloud = random_cloud(257, 3);
  write_glb(folder / "a.glb", cloud);
  const Glb glb(folder / "a.glb");
  CHECK(glb.json["extensionsUsed"][0] == "KHR_gaussian_splatting");
  CHECK(glb.json["nodes"][glb.json["scenes"][0]["nodes"][0].get<std::size_t>()]["mesh"] == 0);
  const nlohmann::json& primitive = glb.primitive();
  CHECK(primitive["mode"] == 0);
  CHECK(primitive["extensions"]["KHR_gaussian_splatting"]["kernel"] == "ellipse");
  CHECK(primitive["extensions"]["KHR_gaussian_splatting"]["colorSpace"] == "srgb_rec709_display");
  const nlohmann::json& attributes = primitive["attributes"];
  const auto of = [&](const std::string& name) {
    return glb.floats(attributes.at("KHR_gaussian_splatting:" + name));
  };
  const auto position = glb.floats(attributes["POSITION"]), scale = of("SCALE"), rotation = of("ROTATION"),
             opacity = of("OPACITY");
  const Eigen::Matrix3f turn = Eigen::Vector3f(1, -1, -1).asDiagonal();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    CHECK((turn * cloud.means[i]).isApprox(Eigen::Vector3f(&position[3 * i]), 0));
    CHECK(cloud.log_scales[i].array().exp().matrix().isApprox(Eigen::Vector3f(&scale[3 * i])));
    CHECK(opacity[i] == doctest::Approx(test::opacity(cloud.opacity_logits[i])));
    const Eigen::Quaternionf q(rotation[4 * i + 3], rotation[4 * i], rotation[4 * i + 1],
                               rotation[4 * i + 2]);
    CHECK(q.norm() == doctest::Approx(1));
    const Eigen::Vector4f& ours = cloud.rotations[i];
    const Eigen::Quaternionf p(ours[0], ours[1], ours[2], ours[3]);
    // The axes of the ellipsoid turn with the world; which way along an axis does not matter.
    const Eigen::Matrix3f same = q.toRotationMatrix().transpose() * turn * p.normalized().toRotationMatrix();
    CHECK(same.cwiseAbs().isApprox(Eigen::Matrix3f::Identity(), 1e-5f));
  }
}

TEST_CASE("binary glTF shows from each side the colours that the map has there") {
  const TemporaryFolder folder;
  const GaussianCloud cloud = random_cloud(3, 3);
  write_glb(folder / "a.glb", cloud);
  const Glb glb(folder / "a.glb");
  GaussianCloud turned = cloud;
  std::size_t k = 0;
  for (int degree = 0; degree <= 3; ++degree)
    for (int n = 0; n <= 2 * degree; ++n, ++k) {
      const auto values = glb.floats(glb.primitive()["attributes"].at(
          "KHR_gaussian_splatting:SH_DEGREE_" + std::to_string(degree) + "_COEF_" + std::to_string(n)));
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t c = 0; c < 3; ++c) turned.sh[(i * 16 + k) * 3 + c] = values[3 * i + c];
    }
  const Eigen::Vector3d direction = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  const Eigen::Vector3d seen_from_there(direction.x(), -direction.y(), -direction.z());
  const auto colour = [](const GaussianCloud& of, const Eigen::Vector3d& towards) {
    const auto basis = reference::sh_basis(towards);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < 16; ++i)
      sum += basis[i] * Eigen::Map<const Eigen::Vector3f>(&of.sh[3 * i]).cast<double>();
    return sum;
  };
  CHECK(colour(cloud, direction).isApprox(colour(turned, seen_from_there), 1e-6));
}

TEST_CASE("binary glTF has points to fall back on, with linear colours and the bounds of the positions") {
  const TemporaryFolder folder;
  GaussianCloud cloud = random_cloud(2, 0);
  cloud.means = {{1, 2, 3}, {-4, 5, -6}};
  cloud.sh = {0, 9, -9, 0, 0, 0};
  cloud.opacity_logits[0] = 0;
  write_glb(folder / "a.glb", cloud);
  const Glb glb(folder / "a.glb");
  const nlohmann::json& attributes = glb.primitive()["attributes"];
  const auto colours = glb.shorts(attributes["COLOR_0"]);
  CHECK(colours[0] == std::lround(0.21404114 * 65535));  // the light of a picture's middle grey
  CHECK(colours[1] == 65535);
  CHECK(colours[2] == 0);
  CHECK(colours[3] == 32768);
  const nlohmann::json& position = glb.json["accessors"][attributes["POSITION"].get<std::size_t>()];
  CHECK(position["min"] == nlohmann::json({-4, -5, -3}));
  CHECK(position["max"] == nlohmann::json({1, -2, 6}));
}

TEST_CASE("binary glTF holds no Gaussian, leaves out wrong ones, and keeps numbers finite") {
  const TemporaryFolder folder;
  write_glb(folder / "a.glb", GaussianCloud());
  CHECK(Glb(folder / "a.glb").binary.empty());
  CHECK_FALSE(Glb(folder / "a.glb").json.contains("meshes"));
  GaussianCloud cloud = random_cloud(3, 0);
  cloud.means[1].x() = std::numeric_limits<float>::quiet_NaN();
  cloud.log_scales[0] = {1000, -1000, 0};
  cloud.opacity_logits = {200, 0, -200};
  write_glb(folder / "a.glb", cloud);
  const Glb glb(folder / "a.glb");
  const nlohmann::json& attributes = glb.primitive()["attributes"];
  CHECK(glb.floats(attributes["KHR_gaussian_splatting:OPACITY"]) == std::vector<float>{1, 0});
  CHECK(glb.floats(attributes["KHR_gaussian_splatting:SCALE"])[0] == std::numeric_limits<float>::max());
  CHECK(glb.floats(attributes["KHR_gaussian_splatting:SCALE"])[1] == 0);
  CHECK(contains(input_error([&] { write_glb(folder / "no/a.glb", cloud); }), "create it first"));
}

TEST_CASE("a mesh becomes binary glTF with its colours, unlit, or without any") {
  const TemporaryFolder folder;
  TriangleMesh mesh{{{0, 0, 0}, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}},
                    {{0, 0.5f, 1}, {0, 0, 0}, {0, 0, 0}, {1, 1, 1}},
                    {{0, 1, 2}, {0, 2, 3}}};
  write_glb(folder / "a.glb", mesh);
  const Glb glb(folder / "a.glb");
  CHECK(glb.primitive()["mode"] == 4);
  CHECK(glb.floats(glb.primitive()["attributes"]["POSITION"])[4] == -2);
  CHECK(glb.values<uint32_t>(glb.primitive()["indices"], 5125) == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  CHECK(glb.shorts(glb.primitive()["attributes"]["COLOR_0"])[1] == std::lround(0.21404114 * 65535));
  CHECK(glb.json["materials"][0]["extensions"].contains("KHR_materials_unlit"));
  mesh.colours.clear();
  write_glb(folder / "a.glb", mesh);
  CHECK_FALSE(Glb(folder / "a.glb").primitive()["attributes"].contains("COLOR_0"));
  CHECK_FALSE(Glb(folder / "a.glb").json.contains("extensionsUsed"));
  write_glb(folder / "a.glb", TriangleMesh());
  CHECK(Glb(folder / "a.glb").binary.empty());
}
