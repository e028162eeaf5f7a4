#include "engine/slam/settings.h"

#include <climits>

#include "engine/config/config.h"

namespace surefield {

namespace {

constexpr Range kFraction{0, 1};
constexpr Range kWeight{0, 1000};
constexpr Range kRate{0, 1};
constexpr Range kFactor{0, 1e6};
constexpr Range kSteps{0, 100000};

// Names that keys had in files of users, and those that they have.
constexpr std::pair<const char*, const char*> kRenamed[] = {
    {"first_tracking_iterations", "adam.first_iterations"},
    {"tracking.iterations", "adam.iterations"},
    {"tracking.rate_rotation", "adam.rate_rotation"},
    {"tracking.rate_translation", "adam.rate_translation"},
    {"tracking.pose_gradient", "adam.pose_gradient"},
    {"tracking.stop_below", "adam.stop_below"},
    {"tracking.renders", "gauss_newton.renders"},
    {"tracking.balance", "gauss_newton.balance"},
    {"tracking.references", "gauss_newton.references"},
    {"tracking.reference_weight", "gauss_newton.reference_weight"}};

void bind_tracking(ConfigSchema& schema, TrackingSettings& tracking) {
  schema.add(
      "tracking.method", &tracking.method,
      Choices<TrackingMethod>{{"gauss-newton", TrackingMethod::GaussNewton}, {"adam", TrackingMethod::Adam}},
      "second-order alignment to a render and to keyframes (keys under gauss_newton), or the paper's "
      "gradient descent through the renderer (keys under adam)");
  schema.add("tracking.weight_colour", &tracking.weight_colour, kWeight,
             "lambda_1, weight of the mean colour difference (colours are 0 to 1)");
  schema.add("tracking.weight_depth", &tracking.weight_depth, kWeight,
             "lambda_2, weight of the mean depth difference (metres)");
  schema.add("tracking.minimum_opacity", &tracking.minimum_opacity, kFraction,
             "pixels take part where the rendered opacity is above");
  schema.add("tracking.outlier_factor", &tracking.outlier_factor, kFactor,
             "pixels take part where their difference is below this many times the median");
  schema.add("tracking.uncertainty_above", &tracking.uncertainty_above, kFactor,
             "Gaussians of a larger uncertainty take no part, square metres; 0: all do");
  schema.add("tracking.depth", &tracking.depth,
             Choices<DepthKind>{{"alpha", DepthKind::Alpha}, {"normalised", DepthKind::Normalised}},
             "rendered depth that is compared: blended as it is, or divided by the opacity");
}

void bind_gauss_newton(ConfigSchema& schema, GaussNewtonSettings& gauss_newton) {
  schema.add("gauss_newton.renders", &gauss_newton.renders, Range{1, 1000},
             "renders that a frame is aligned to, at most");
  schema.add("gauss_newton.balance", &gauss_newton.balance, kWeight,
             "weight of the geometric residuals beside the photometric ones");
  schema.add("gauss_newton.references", &gauss_newton.references, Range{0, 4},
             "keyframes of the window whose own images a frame is aligned to beside the render, the newest "
             "first; 0: the render alone");
  schema.add("gauss_newton.reference_weight", &gauss_newton.reference_weight, kWeight,
             "weight of each of them beside the render");
}

void bind_adam(ConfigSchema& schema, AdamSettings& adam) {
  schema.add("adam.iterations", &adam.iterations, Range{1, 100000}, "steps per frame, at most");
  schema.add("adam.first_iterations", &adam.first_iterations, Range{1, 100000},
             "steps of the first tracked frame, at most, where these are more");
  schema.add("adam.rate_rotation", &adam.rate_rotation, kRate, "step of the rotation, radians");
  schema.add("adam.rate_translation", &adam.rate_translation, kRate, "step of the translation, metres");
  schema.add("adam.pose_gradient", &adam.pose_gradient,
             Choices<PoseGradientKind>{{"full", PoseGradientKind::Full}, {"light", PoseGradientKind::Light}},
             "terms of the pose's gradient: all, or those through the projected centre and the depth");
  schema.add("adam.stop_below", &adam.stop_below, kRate,
             "tracking ends when all steps have become smaller, radians and metres; 0: never early");
}

void bind_mapping(ConfigSchema& schema, MappingSettings& mapping) {
  schema.add("mapping.weight_colour", &mapping.weight_colour, kWeight,
             "weight of the mean colour difference");
  schema.add("mapping.weight_ssim", &mapping.weight_ssim, kWeight, "weight of 1 - SSIM");
  schema.add("mapping.weight_depth", &mapping.weight_depth, kWeight,
             "weight of the mean depth difference (metres)");
  schema.add("mapping.weight_align", &mapping.weight_align, kWeight,
             "weight of the difference between blended and median depth");
  schema.add("mapping.weight_isotropy", &mapping.weight_isotropy, kWeight,
             "weight of the penalty on elongated Gaussians");
  schema.add("mapping.isotropy_epsilon", &mapping.isotropy_epsilon, Range{1, 1e6},
             "that penalty begins where the largest scale is so many times the smallest");
  schema.add("mapping.weight_variance", &mapping.weight_variance, kWeight,
             "weight of the depth variance along a ray (the uncertainty)");
  schema.add("mapping.uncertainty_above", &mapping.uncertainty_above, kFactor,
             "tau, Gaussians of a larger uncertainty (mean squared error of the depth where they dominate, "
             "square metres) lose their opacity; 0: none is judged");
  schema.add("mapping.uncertain_opacity", &mapping.uncertain_opacity, Range{0.0001, 0.99},
             "the opacity that is left to them");
  schema.add("mapping.depth", &mapping.depth,
             Choices<DepthKind>{{"alpha", DepthKind::Alpha}, {"normalised", DepthKind::Normalised}},
             "rendered depth that is compared: blended as it is, or divided by the opacity");
  schema.add("mapping.rate_mean", &mapping.rate_mean, kRate,
             "Adam's step of the centres, times the scene's extent");
  schema.add("mapping.rate_log_scale", &mapping.rate_log_scale, kRate,
             "Adam's step of the log-scales, times the scene's extent");
  schema.add("mapping.rate_rotation", &mapping.rate_rotation, kRate, "Adam's step of the quaternions");
  schema.add("mapping.rate_opacity", &mapping.rate_opacity, kRate, "Adam's step of the opacity logits");
  schema.add("mapping.rate_colour", &mapping.rate_colour, kRate,
             "Adam's step of the colour coefficients; a twentieth of it for those of degree 1 and above");
  schema.add("mapping.rate_pose_rotation", &mapping.rate_pose_rotation, kRate,
             "Adam's step of the keyframes' rotations, radians");
  schema.add("mapping.rate_pose_translation", &mapping.rate_pose_translation, kRate,
             "Adam's step of the keyframes' translations, metres");
  schema.add("mapping.pose_gradient", &mapping.pose_gradient,
             Choices<PoseGradientKind>{{"full", PoseGradientKind::Full}, {"light", PoseGradientKind::Light}},
             "terms of the poses' gradient: all, or those through the projected centre and the depth");
}

void bind_densify(ConfigSchema& schema, DensifySettings& densify) {
  schema.add("densify.gradient_threshold", &densify.gradient_threshold, kFactor,
             "Gaussians with a larger mean screen gradient (in half images) are split or cloned");
  schema.add("densify.split_scale", &densify.split_scale, kFactor,
             "larger ones are split, smaller ones cloned; metres, times the scene's extent");
  schema.add("densify.minimum_opacity", &densify.minimum_opacity, kFraction, "fainter ones are removed");
  schema.add("densify.maximum_scale", &densify.maximum_scale, kFactor,
             "larger ones are removed; metres, times the scene's extent");
}

void bind_spawn(ConfigSchema& schema, SpawnSettings& spawn) {
  schema.add("spawn.opacity_below", &spawn.opacity_below, kFraction,
             "psi, a pixel whose rendered opacity is below spawns a Gaussian");
  schema.add("spawn.front_factor", &spawn.front_factor, kFactor,
             "a pixel also spawns one where the map lies behind the sensor depth by this many median errors; "
             "0: never");
  schema.add("spawn.opacity", &spawn.opacity, Range{0.005, 0.99}, "opacity at birth");
  schema.add("spawn.footprint", &spawn.footprint, Range{0.01, 100},
             "radius at birth, in pixels at the Gaussian's depth");
  schema.add("spawn.thickness", &spawn.thickness, Range{0.01, 1},
             "thickness at birth along the normal of the sensor's surface, in radii; 1: a sphere");
}

void bind_keyframes(ConfigSchema& schema, KeyframeSettings& keyframes) {
  schema.add("keyframes.interval", &keyframes.interval, Range{1, 100000},
             "every so many frames is a keyframe");
  schema.add(
      "keyframes.valid_below", &keyframes.valid_below, kFraction,
      "also when the map explains less of the sensor's depth than this times what it explained just after "
      "the last keyframe");
  schema.add("keyframes.exposure", &keyframes.exposure,
             "keyframes' colours are brought to the exposure of the map by a gain for each channel");
  schema.add("keyframes.window", &keyframes.window, Range{1, 1000},
             "k, keyframes optimised together: the current, the most recent, and the k - 2 that see most "
             "of the same");
  schema.add("keyframes.past_keyframes", &keyframes.past_keyframes, Range{0, 1000},
             "random older keyframes among the steps, against forgetting");
  schema.add(
      "keyframes.near", &keyframes.near, Range{1, 1000000},
      "the window and the older keyframes are among this many that are nearest to the current one; the "
      "Gaussians that none of them sees wait in host memory");
  schema.add("keyframes.covisibility", &keyframes.covisibility,
             Choices<CovisibilityKind>{{"overlap", CovisibilityKind::Overlap},
                                       {"vlad", CovisibilityKind::Vlad},
                                       {"netvlad", CovisibilityKind::NetVlad}},
             "what says which keyframes see the same: reprojected depth, or the similarity of descriptors of "
             "all images (docs/places.md)");
  schema.add("keyframes.vocabulary", &keyframes.vocabulary,
             "vlad: file of visual words from surefield vocabulary; empty: the built-in one");
  schema.add("keyframes.netvlad", &keyframes.netvlad, "netvlad: the network, an ONNX file");
}

}  // namespace

void SlamSettings::bind(ConfigSchema& schema) {
  schema.add("seed", &seed, Range{0, INT_MAX}, "drives every random choice");
  schema.add("depth_max", &depth_max, Range{0.1, 1000}, "metres, sensor depth beyond is not used");
  schema.add(
      "map_device_mb", &map_device_mb, Range{1, 1e6},
      "device memory that the Gaussians may take, 10^6 bytes; those that it does not hold wait in host "
      "memory");
  schema.add("first_iterations", &first_iterations, kSteps, "mapping steps on the first frame");
  schema.add("mapping_iterations", &mapping_iterations, kSteps, "mapping steps per keyframe");
  schema.add("depth_model", &depth_model,
             Choices<DepthModel>{{"centre", DepthModel::Centre}, {"plane", DepthModel::Plane}},
             "depth of a Gaussian over its footprint: that of its centre, or that of a plane through it, "
             "which surefield render and view take for a map without its run");
  bind_tracking(schema, tracking);
  bind_gauss_newton(schema, tracking.gauss_newton);
  bind_adam(schema, tracking.adam);
  bind_mapping(schema, mapping);
  bind_keyframes(schema, keyframes);
  bind_spawn(schema, spawn);
  bind_densify(schema, densify);
  schema.add("lost.loss_jump", &lost.loss_jump, kFactor,
             "a frame is lost when its loss is above this many times the mean of the last frames");
  schema.add("lost.minimum_valid", &lost.minimum_valid, kFraction,
             "or when a smaller fraction of the pixels with sensor depth took part in tracking");
  for (const auto& [old, key] : kRenamed) schema.renamed(old, key);
}

}  // namespace surefield
