#include "tools/eval/eval_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/eval/mesh_alignment.h"
#include "engine/eval/mesh_metrics.h"
#include "engine/io/files.h"
#include "engine/types/error.h"
#include "tools/results/run_folder.h"
#include "tools/shared/command.h"
#include "tools/shared/load_map.h"

namespace surefield {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostCameras = 200;
constexpr double kWidth = 320;  // pixels, at most, of the images that decide what is seen

/// The dataset whose cameras cull, and the run's poses, as far as they are given.
struct Surroundings {
  std::optional<RunFolder> run;
  std::optional<Dataset> dataset;
};

Surroundings open_surroundings(const EvalMeshOptions& options) {
  Surroundings result;
  if (!options.run.empty()) {
    result.run = read_run(options.run);
    result.dataset = open_dataset_of(*result.run, options.dataset);
  } else if (!options.dataset.empty()) {
    result.dataset = open_dataset(options.dataset);
  }
  if (result.dataset && !result.dataset->ground_truth) {
    throw InputError("the dataset " + result.dataset->recording->name() +
                     " has no true poses; neither culling nor a run's frame is known without");
  }
  return result;
}

/// The dataset's true cameras, evenly picked.
std::vector<Camera> true_cameras(const Dataset& dataset) {
  const Intrinsics original = dataset.recording->intrinsics();
  const Intrinsics intrinsics = original.scaled(std::min(1.0, kWidth / original.width));
  Trajectory poses;
  for (const StampedPose& pose : of_tracked_camera(*dataset.ground_truth, *dataset.recording)) {
    if (pose.is_finite()) poses.push_back(pose);
  }
  const std::size_t count = std::min(kMostCameras, poses.size());
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = count < 2 ? 0 : i * (poses.size() - 1) / (count - 1);
    cameras.push_back({intrinsics, poses[at].camera_to_world.inverse()});
  }
  return cameras;
}

MeshComparison comparison_for(const Surroundings& surroundings) {
  MeshComparison comparison;
  if (!surroundings.dataset) return comparison;
  comparison.cameras = true_cameras(*surroundings.dataset);
  if (surroundings.run) {
    comparison.start =
        align_poses(associate(surroundings.run->trajectory, *surroundings.dataset->ground_truth));
  }
  return comparison;
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json to_json(const SurfaceDistances& d) {
  return {{"accuracy_m", d.accuracy},
          {"completion_m", d.completion},
          {"completion_ratio_5cm", d.completion_ratio},
          {"precision_1cm", d.precision},
          {"recall_1cm", d.recall},
          {"f1_1cm", d.f1()}};
}

Json to_json(const MeshMetrics& m) {
  Json rows = Json::array();
  for (int i = 0; i < 4; ++i) {
    Json row = Json::array();
    for (int k = 0; k < 4; ++k) row.push_back(m.alignment.matrix()(i, k));
    rows.push_back(row);
  }
  return {{"nearest_triangle", to_json(m.nearest_triangle)},
          {"point_to_point", to_json(m.point_to_point)},
          {"depth_l1_m", m.depth ? number(m.depth->mean) : Json(nullptr)},
          {"depth_shown", m.depth ? number(m.depth->shown) : Json(nullptr)},
          {"area_m2", m.area},
          {"truth_area_m2", m.truth_area},
          {"kept", m.kept},
          {"truth_kept", m.truth_kept},
          {"alignment", rows}};
}

Json to_json(const CentreDistances& d) {
  return {{"centres", d.centres},
          {"to_surface_mean_m", d.mean},
          {"to_surface_median_m", d.median},
          {"surface_to_centres_mean_m", d.to_centres},
          {"chamfer_m", d.chamfer()}};
}

std::string lines(const char* name, const SurfaceDistances& d) {
  return fmt::format(
      "{:<16} accuracy {:.3f} cm, completion {:.3f} cm, ratio < 5 cm {:.2f} %, F1 at 1 cm {:.2f} %\n", name,
      100 * d.accuracy, 100 * d.completion, 100 * d.completion_ratio, 100 * d.f1());
}

std::string table(const MeshMetrics& m) {
  std::string text = lines("nearest triangle", m.nearest_triangle);
  text += lines("point to point", m.point_to_point);
  if (m.depth) {
    text += fmt::format("depth L1         {:.3f} cm, over {:.2f} % of what is to be seen\n",
                        100 * m.depth->mean, 100 * m.depth->shown);
    text += fmt::format("kept by culling  {:.1f} % of the mesh, {:.1f} % of the truth\n", 100 * m.kept,
                        100 * m.truth_kept);
  }
  return text;
}

std::string table(const CentreDistances& d) {
  return fmt::format(
      "Gaussian centres {}: to the surface {:.3f} cm (median {:.3f}), the surface to them {:.3f} cm, Chamfer "
      "{:.3f} cm\n",
      d.centres, 100 * d.mean, 100 * d.median, 100 * d.to_centres, 100 * d.chamfer());
}

std::vector<Eigen::Vector3d> centres_of(const std::string& map) {
  std::vector<Eigen::Vector3d> centres;
  for (const Eigen::Vector3f& mean : load_map(map).means) centres.push_back(mean.cast<double>());
  if (centres.empty()) throw InputError(map, "holds no Gaussian");
  return centres;
}

}  // namespace

void add_mesh_options(CLI::App& eval, EvalMeshOptions& options) {
  CLI::Option* truth = eval.add_option("--ground-truth-mesh", options.truth,
                                       "True mesh, PLY, in the frame of the dataset's true poses");
  eval.add_option("--mesh", options.mesh, "Mesh to compare with it, PLY")->needs(truth);
  eval.add_option("--map", options.map, "Gaussians whose centres to compare with it, PLY or SPZ")
      ->needs(truth);
}

int evaluate_mesh(const EvalMeshOptions& options) {
  if (options.mesh.empty() && options.map.empty()) {
    throw InputError("--ground-truth-mesh needs something to compare: give --mesh, --map or both");
  }
  const TriangleMesh truth = read_mesh(options.truth);
  const MeshComparison comparison = comparison_for(open_surroundings(options));
  Json json = {{"schema", "surefield-mesh"}, {"version", 1}, {"cameras", comparison.cameras.size()}};
  std::string text;
  if (comparison.cameras.empty()) text += "no dataset given: nothing is culled\n";
  if (!options.mesh.empty()) {
    const MeshMetrics metrics = compare_meshes(read_mesh(options.mesh), truth, comparison);
    json["mesh"] = to_json(metrics);
    text += table(metrics);
  }
  if (!options.map.empty()) {
    const CentreDistances distances = compare_centres(centres_of(options.map), truth, comparison);
    json["gaussians"] = to_json(distances);
    text += table(distances);
  }
  if (!options.json.empty()) {
    write_file(options.json, [&](std::ostream& stream) { stream << json.dump(2) << "\n"; });
  }
  fmt::print("{}", text);
  return kSuccess;
}

}  // namespace surefield
