#include "tools/tables/table_specs.h"

namespace surefield {

namespace {

const std::vector<std::string> kReplica = {"room0",   "room1",   "room2",   "office0",
                                           "office1", "office2", "office3", "office4"};

const TableMetric kAte = {"ATE RMSE [cm]", 2, {"metrics.json", "/trajectory/ate_rmse_m", 100}};

std::vector<TableMetric> image_metrics() {
  return {{"PSNR [dB]", 2, {"metrics.json", "/images/psnr_db"}},
          {"SSIM", 4, {"metrics.json", "/images/ssim"}},
          {"Depth L1 [cm]", 2, {"metrics.json", "/images/depth_l1_m", 100}}};
}

/// How far a mesh is from the true one: by samples on both, as papers measure it, and by nearest triangles.
std::vector<TableMetric> surface_metrics() {
  const auto samples = [](const char* key) {
    return NumberSource{"mesh.json", "/mesh/point_to_point/" + std::string(key), 100};
  };
  const auto nearest = [](const char* key) {
    return NumberSource{"mesh.json", "/mesh/nearest_triangle/" + std::string(key), 100};
  };
  return {{"Accuracy [cm]", 2, samples("accuracy_m")},
          {"Completion [cm]", 2, samples("completion_m")},
          {"Completion ratio < 5 cm [%]", 2, samples("completion_ratio_5cm")},
          {"F1 at 1 cm [%]", 2, samples("f1_1cm")},
          {"Accuracy, nearest triangle [cm]", 2, nearest("accuracy_m")},
          {"Completion, nearest triangle [cm]", 2, nearest("completion_m")},
          {"Completion ratio < 5 cm, nearest triangle [%]", 2, nearest("completion_ratio_5cm")},
          {"F1 at 1 cm, nearest triangle [%]", 2, nearest("f1_1cm")},
          {"Depth L1 of the mesh [cm]", 2, {"mesh.json", "/mesh/depth_l1_m", 100}}};
}

std::vector<TableMetric> runtime_metrics() {
  return {{"tracking [ms x it]",
           2,
           {"metrics.json", "/time/tracking_ms_per_iteration"},
           NumberSource{"metrics.json", "/time/tracking_iterations"},
           NumberSource{"metrics.json", "/frames/fed"}},
          {"mapping [ms x it]",
           2,
           {"metrics.json", "/time/mapping_ms_per_iteration"},
           NumberSource{"metrics.json", "/time/mapping_iterations"},
           NumberSource{"metrics.json", "/frames/keyframes"}},
          {"keyframe every",
           1,
           {"metrics.json", "/frames/fed"},
           std::nullopt,
           NumberSource{"metrics.json", "/frames/keyframes"}},
          {"frames/s", 2, {"metrics.json", "/time/frames_per_second"}},
          {"map [MB]", 2, {"metrics.json", "/map/megabytes"}},
          {"device peak [MB]", 1, {"metrics.json", "/memory/device_peak_mb"}},
          {"host peak [MB]", 1, {"metrics.json", "/memory/host_peak_mb"}}};
}

/// What each of the paper's terms is worth, and each of our own choices.
TableSpec ablations() {
  return {"ablations",
          "Ablations",
          "ablations",
          {"office", "apartment", "corridor", "fr1_xyz", "redkitchen", "room0"},
          {{"ATE RMSE [cm]", 3, {"metrics.json", "/trajectory/ate_rmse_m", 100}},  // some are tenths of a mm
           {.name = "PSNR [dB]", .source = {"metrics.json", "/images/psnr_db"}, .larger_is_better = true},
           {"Depth L1 [cm]", 2, {"metrics.json", "/images/depth_l1_m", 100}}},
          {{"full", "full"},
           {"no-isotropy", "without L_iso"},
           {"no-align", "without L_align"},
           {"no-variance", "without L_var"},
           {"no-align-variance", "without L_align and L_var"},
           {"no-uncertainty", "without uncertainty"},
           {"pose-gradient-light", "light gradient of the pose"},
           {"depth-centre", "depth of the centre"},
           {"newborn-spheres", "newborn spheres"},
           {"no-references", "tracking without images of keyframes"},
           {"refined-keyframes", "poses of keyframes refined with the map"},
           {"depth-alpha", "depth in mapping not divided by the opacity"},
           {"tracking-adam", "tracking by Adam"},
           {"covisibility-vlad", "covisibility by VLAD"}},
          true,
          "full"};
}

std::vector<TableSpec> make_specs() {
  const TableVariant full{"full", "Surefield"};
  const std::vector<std::string> tum = {"fr1_desk", "fr1_desk2", "fr1_room", "fr2_xyz", "fr3_office"};
  const std::vector<std::string> scannet = {"scene0000", "scene0059", "scene0106",
                                            "scene0169", "scene0181", "scene0207"};
  const std::vector<std::string> synthetic = {"office", "apartment", "corridor", "hall"};
  std::vector<TableMetric> own = image_metrics();
  own.insert(own.begin(), kAte);
  const std::vector<TableMetric> surface = surface_metrics();
  own.insert(own.end(), surface.begin(), surface.end());
  own.push_back({"frames/s", 2, {"metrics.json", "/time/frames_per_second"}});
  return {{"tracking-replica", "Tracking on Replica", "replica", kReplica, {kAte}},
          {"tracking-tum", "Tracking on TUM RGB-D", "tum", tum, {kAte}},
          {"tracking-scannet", "Tracking on ScanNet", "scannet", scannet, {kAte}},
          {"rendering", "Rendering on Replica, all frames", "replica", kReplica, image_metrics()},
          {"reconstruction", "Reconstruction on Replica", "replica", kReplica, surface_metrics()},
          {"runtime",
           "Runtime and memory on Replica office0",
           "replica",
           {"office0"},
           runtime_metrics(),
           {full},
           true},
          {"ablation-isotropy",
           "Without the isotropy loss, on Replica",
           "replica",
           kReplica,
           {kAte},
           {{"no-isotropy", "Surefield without L_iso"}, full}},
          {"ablation-losses",
           "Without the alignment and variance losses, mean over Replica",
           "replica",
           kReplica,
           {kAte, {"Chamfer distance [cm]", 2, {"mesh.json", "/gaussians/chamfer_m", 100}}},
           {{"no-align", "Surefield without L_align"},
            {"no-variance", "Surefield without L_var"},
            {"no-align-variance", "Surefield without L_align and L_var"},
            full},
           true},
          {"synthetic", "Synthetic scenes", "synthetic", synthetic, own},
          ablations()};
}

}  // namespace

const std::vector<TableSpec>& table_specs() {
  static const std::vector<TableSpec> specs = make_specs();
  return specs;
}

}  // namespace surefield
