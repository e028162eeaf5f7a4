// --up and --axes: where up is, as a person says it, and upright meshes.
#include <Eigen/Geometry>

#include "engine/formats/mesh_file.h"
#include "engine/formats/ply.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Two Gaussians, a red one at (0, -1, 3) and a blue one at (0, 1, 3).
void write_pair(const std::filesystem::path& file) {
  GaussianCloud cloud;
  cloud.resize(2);
  cloud.means = {{0, -1, 3}, {0, 1, 3}};
  cloud.sh = {1.5f, -1, -1, -1, -1, 1.5f};
  for (int i = 0; i < 2; ++i) {
    cloud.log_scales[i].setConstant(std::log(0.3f));
    cloud.opacity_logits[i] = 5;
  }
  write_ply(file, cloud);
}

/// The mean row of the pixels in which that channel is strong.
double row_of(const cv::Mat& rgb, int channel) {
  double sum = 0, count = 0;
  for (int y = 0; y < rgb.rows; ++y)
    for (int x = 0; x < rgb.cols; ++x)
      if (rgb.at<cv::Vec3b>(y, x)[channel] > 150) {
        sum += y;
        ++count;
      }
  REQUIRE(count > 0);
  return sum / count;
}

Eigen::Vector3d direction_of(const nlohmann::json& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

TEST_CASE("an orbit and a page have upwards what the user says") {
  const TemporaryFolder folder;
  write_pair(folder / "map.ply");
  const auto first_picture = [&](const std::string& up) {
    const Outcome outcome =
        surefield_command({"render", "--map", folder / "map.ply", "--path", "orbit", "--up", up, "--size",
                           "64x48", "--fps", "2", "--seconds", "0.5", "--out", folder / up},
                          folder.path());
    REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
    return read_colour(folder / up / "000000.png");
  };
  for (const char* upright : {"camera", "0,-1,0", "-0.01,-3,0"}) {
    CAPTURE(upright);
    const cv::Mat picture = first_picture(upright);
    CHECK(row_of(picture, 0) < row_of(picture, 2));
  }
  const cv::Mat reversed = first_picture("0,2,0");
  CHECK(row_of(reversed, 0) > row_of(reversed, 2));

  const Outcome page = surefield_command(
      {"export", "--map", folder / "map.ply", "--up=0,0,-2", "--web", folder / "web"}, folder.path());
  REQUIRE_MESSAGE(page.code == 0, page.err);
  const std::string html = read_file(folder / "web/index.html");
  CHECK((contains(html, R"("up":[0.0,0.0,-1.0])") || contains(html, R"("up":[-0.0,0.0,-1.0])")));
}

TEST_CASE("--up refuses what is no direction, and stands where it has a meaning") {
  const TemporaryFolder folder;
  write_pair(folder / "map.ply");
  const auto error = [&](std::vector<std::string> arguments) {
    const Outcome outcome = surefield_command(std::move(arguments), folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  const std::vector<std::string> orbit = {"render", "--map", folder / "map.ply", "--path",
                                          "orbit",  "--out", folder / "film"};
  for (const char* wrong : {"0,0,0", "nan,0,1", "inf,0,1", "1,2", "1,2,3,4", "0,-1,0m", "down", ""}) {
    CAPTURE(wrong);
    CHECK(contains(error(with(orbit, {std::string("--up=") + wrong})),
                   "three finite numbers that are not all"));
  }
  CHECK(contains(error({"render", "--map", folder / "map.ply", "--camera", "c.json", "--up", "0,-1,0",
                        "--out", folder / "film"}),
                 "--path"));
  const std::string keys = folder.write("keys.json", "{}");
  CHECK(contains(error({"render", "--map", folder / "map.ply", "--path", keys, "--up", "0,-1,0", "--out",
                        folder / "film"}),
                 "--up is where up is for --path orbit"));
  CHECK(contains(error({"export", "--map", folder / "map.ply", "--up", "0,-1,0", "--out", folder / "b.ply"}),
                 "maps are written in the world of their run"));
}

TEST_CASE("a run is told where up is, and its mesh stands upright; eval compares it in the run's world") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(with(short_run(folder / "out"), {"--up", "0,-4,-3"}), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const nlohmann::json up = read_json(folder / "out/metrics.json")["up"];
  const Eigen::Vector3d given(0, -0.8, -0.6);
  CHECK(up["given"] == true);
  CHECK(up["measured"] == false);
  CHECK(direction_of(up["direction"]).isApprox(given, 1e-12));

  const auto mesh = [&](const std::string& name, const std::vector<std::string>& more) {
    const Outcome outcome = surefield_command(with({"mesh", "--run", folder / "out", "--voxel", "0.06",
                                                    "--truncation", "0.24", "--out", folder / name},
                                                   more),
                                              folder.path());
    REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
    return outcome.out;
  };
  CHECK(contains(mesh("upright.ply", {}), "axes             z-up"));
  CHECK(contains(mesh("world.ply", {"--axes", "world"}), "axes             world"));
  CHECK(contains(mesh("upright.glb", {}), "axes             y-up"));
  CHECK(contains(mesh("other.ply", {"--axes", "y-up", "--up", "0,-1,0"}), "axes             y-up"));
  const TriangleMesh upright = read_mesh(folder / "upright.ply"), world = read_mesh(folder / "world.ply");
  CHECK(upright.up->isApprox(given, 1e-12));
  CHECK_FALSE(world.up);
  CHECK(read_mesh(folder / "other.ply").up->isApprox(Eigen::Vector3d(0, -1, 0)));
  REQUIRE(upright.vertices.size() == world.vertices.size());
  for (std::size_t i = 0; i < world.vertices.size(); i += 50)
    CHECK(upright.vertices[i].isApprox(world.vertices[i], 1e-5f));

  const Outcome eval = surefield_command({"eval", "--mesh", folder / "upright.ply", "--ground-truth-mesh",
                                          folder / "world.ply", "--json", folder / "eval.json"},
                                         folder.path());
  REQUIRE_MESSAGE(eval.code == 0, eval.err);
  CHECK(read_json(folder / "eval.json")["mesh"]["nearest_triangle"]["accuracy_m"] < 1e-5);

  // Another format keeps it upright, by the axes that are usual there.
  const auto exported = [&](const std::string& from, const std::string& to,
                            const std::vector<std::string>& more = {}) {
    return surefield_command(with({"export", "--mesh", folder / from, "--out", folder / to}, more),
                             folder.path());
  };
  CHECK(exported("upright.ply", "b.obj").code == 0);
  CHECK(contains(read_file(folder / "b.obj"), "# world_to_file y "));
  CHECK(exported("world.ply", "c.obj").code == 0);
  CHECK_FALSE(contains(read_file(folder / "c.obj"), "world_to_file"));
  CHECK(exported("world.ply", "d.ply", {"--up", "0,-4,-3"}).code == 0);
  CHECK(read_mesh(folder / "d.ply").up->isApprox(given, 1e-12));
  CHECK(contains(exported("world.ply", "e.ply", {"--axes", "z-up"}).err,
                 "does not say where up is; give --up"));
  CHECK(contains(exported("world.ply", "e.ply", {"--up", "auto"}).err, "neither a map nor cameras"));

  const auto refusal = [&](const std::vector<std::string>& more, const std::string& name = "no.ply") {
    const Outcome outcome = surefield_command(
        with({"mesh", "--run", folder / "out", "--out", folder / name}, more), folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(contains(refusal({"--axes", "z-up"}, "no.glb"), "glTF has y upwards"));
  CHECK(contains(refusal({"--axes", "world", "--up", "0,-1,0"}), "leave one of them out"));
  CHECK(contains(refusal({"--source", "sensor", "--trajectory", "true", "--axes", "z-up"}), "give --up"));
}
