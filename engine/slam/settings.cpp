#include "engine/slam/settings.h"

#include <climits>

#include "engine/config/built_in_configs.h"
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

constexpr const char* kPixelUnit = "in pixels at the scene's distance";
constexpr const char* kNoExtent = "not multiplied by the scene's extent any more";

void bind_tracking(ConfigSchema& schema, TrackingSettings& tracking) {
  schema.add(
      "tracking.method", &tracking.method,
      Choices<TrackingMethod>{{"gauss-newton", TrackingMethod::GaussNewton}, {"adam", TrackingMethod::Adam}});
  schema.add("tracking.weight_colour", &tracking.weight_colour, kWeight);
  schema.add("tracking.weight_depth", &tracking.weight_depth, kWeight);
  schema.add("tracking.minimum_opacity", &tracking.minimum_opacity, kFraction);
  schema.add("tracking.outlier_factor", &tracking.outlier_factor, kFactor);
  schema.add("tracking.uncertainty_above", &tracking.uncertainty_above, kFactor);
  schema.add("tracking.depth", &tracking.depth,
             Choices<DepthKind>{{"alpha", DepthKind::Alpha}, {"normalised", DepthKind::Normalised}});
}

void bind_gauss_newton(ConfigSchema& schema, GaussNewtonSettings& gauss_newton) {
  schema.add("gauss_newton.renders", &gauss_newton.renders, Range{1, 1000});
  schema.add("gauss_newton.balance", &gauss_newton.balance, kWeight);
  schema.add("gauss_newton.references", &gauss_newton.references, Range{0, 4});
  schema.add("gauss_newton.reference_weight", &gauss_newton.reference_weight, kWeight);
}

void bind_adam(ConfigSchema& schema, AdamSettings& adam) {
  schema.add("adam.iterations", &adam.iterations, Range{1, 100000});
  schema.add("adam.first_iterations", &adam.first_iterations, Range{1, 100000});
  schema.add("adam.rate_rotation", &adam.rate_rotation, kRate);
  schema.add("adam.rate_translation", &adam.rate_translation, kRate);
  schema.add("adam.pose_gradient", &adam.pose_gradient,
             Choices<PoseGradientKind>{{"full", PoseGradientKind::Full}, {"light", PoseGradientKind::Light}});
  schema.add("adam.stop_below", &adam.stop_below, kRate);
}

void bind_mapping(ConfigSchema& schema, MappingSettings& mapping) {
  schema.add("mapping.weight_colour", &mapping.weight_colour, kWeight);
  schema.add("mapping.weight_ssim", &mapping.weight_ssim, kWeight);
  schema.add("mapping.weight_depth", &mapping.weight_depth, kWeight);
  schema.add("mapping.weight_align", &mapping.weight_align, kWeight);
  schema.add("mapping.weight_isotropy", &mapping.weight_isotropy, kWeight);
  schema.add("mapping.isotropy_epsilon", &mapping.isotropy_epsilon, Range{1, 1e6});
  schema.add("mapping.weight_variance", &mapping.weight_variance, kWeight);
  schema.add("mapping.uncertainty_above", &mapping.uncertainty_above, kFactor);
  schema.add("mapping.uncertain_opacity", &mapping.uncertain_opacity, Range{0.0001, 0.99});
  schema.add("mapping.depth", &mapping.depth,
             Choices<DepthKind>{{"alpha", DepthKind::Alpha}, {"normalised", DepthKind::Normalised}});
  schema.add("mapping.rate_centre", &mapping.rate_centre, kWeight);
  schema.add("mapping.rate_size", &mapping.rate_size, kRate);
  schema.add("mapping.rate_rotation", &mapping.rate_rotation, kRate);
  schema.add("mapping.rate_opacity", &mapping.rate_opacity, kRate);
  schema.add("mapping.rate_colour", &mapping.rate_colour, kRate);
  schema.add("mapping.rate_pose_rotation", &mapping.rate_pose_rotation, kRate);
  schema.add("mapping.rate_pose_translation", &mapping.rate_pose_translation, kRate);
  schema.add("mapping.pose_gradient", &mapping.pose_gradient,
             Choices<PoseGradientKind>{{"full", PoseGradientKind::Full}, {"light", PoseGradientKind::Light}});
}

void bind_densify(ConfigSchema& schema, DensifySettings& densify) {
  schema.add("densify.gradient_threshold", &densify.gradient_threshold, kFactor);
  schema.add("densify.split_scale", &densify.split_scale, kFactor);
  schema.add("densify.minimum_opacity", &densify.minimum_opacity, kFraction);
  schema.add("densify.maximum_scale", &densify.maximum_scale, kFactor);
}

void bind_spawn(ConfigSchema& schema, SpawnSettings& spawn) {
  schema.add("spawn.cell", &spawn.cell, Range{1, 16});
  schema.add("spawn.opacity_below", &spawn.opacity_below, kFraction);
  schema.add("spawn.front_factor", &spawn.front_factor, kFactor);
  schema.add("spawn.opacity", &spawn.opacity, Range{0.005, 0.99});
  schema.add("spawn.footprint", &spawn.footprint, Range{0.01, 100});
  schema.add("spawn.thickness", &spawn.thickness, Range{0.01, 1});
}

void bind_keyframes(ConfigSchema& schema, KeyframeSettings& keyframes) {
  schema.add("keyframes.interval", &keyframes.interval, Range{1, 100000});
  schema.add("keyframes.valid_below", &keyframes.valid_below, kFraction);
  schema.add("keyframes.exposure", &keyframes.exposure);
  schema.add("keyframes.window", &keyframes.window, Range{1, 1000});
  schema.add("keyframes.past_keyframes", &keyframes.past_keyframes, Range{0, 1000});
  schema.add("keyframes.near", &keyframes.near, Range{1, 1000000});
  schema.add("keyframes.covisibility", &keyframes.covisibility,
             Choices<CovisibilityKind>{{"overlap", CovisibilityKind::Overlap},
                                       {"vlad", CovisibilityKind::Vlad},
                                       {"netvlad", CovisibilityKind::NetVlad}});
  schema.add("keyframes.vocabulary", &keyframes.vocabulary);
  schema.add("keyframes.netvlad", &keyframes.netvlad);
}

}  // namespace

void SlamSettings::bind(ConfigSchema& schema) {
  schema.add("seed", &seed, Range{0, INT_MAX});
  schema.add("sensor", &sensor,
             Choices<DepthSensor>{{"structured-light", DepthSensor::StructuredLight},
                                  {"time-of-flight", DepthSensor::TimeOfFlight},
                                  {"stereo", DepthSensor::Stereo},
                                  {"perfect", DepthSensor::Perfect}});
  schema.add("depth_max", &depth_max, Range{0, 1000});
  schema.add("map_device_mb", &map_device_mb, Range{1, 1e6});
  schema.add("first_iterations", &first_iterations, kSteps);
  schema.add("mapping_iterations", &mapping_iterations, kSteps);
  schema.add("budget_ms", &budget_ms, Range{0, 1e6});
  schema.add("depth_model", &depth_model,
             Choices<DepthModel>{{"centre", DepthModel::Centre}, {"plane", DepthModel::Plane}});
  bind_tracking(schema, tracking);
  bind_gauss_newton(schema, tracking.gauss_newton);
  bind_adam(schema, tracking.adam);
  bind_mapping(schema, mapping);
  bind_keyframes(schema, keyframes);
  bind_spawn(schema, spawn);
  bind_densify(schema, densify);
  schema.add("lost.loss_jump", &lost.loss_jump, kFactor);
  schema.add("lost.minimum_valid", &lost.minimum_valid, kFraction);
  schema.add("light.correct_above", &light.correct_above, kFactor);
  schema.add("drift.rotation", &drift.rotation, Range{0, 10});
  schema.add("drift.translation", &drift.translation, Range{0, 1});
  schema.document(built_in_configs().at("base.yaml"));
  for (const auto& [old, key] : kRenamed) schema.renamed(old, key);
  schema.renamed("mapping.rate_mean", "mapping.rate_centre", kPixelUnit);
  schema.renamed("mapping.rate_log_scale", "mapping.rate_size", kNoExtent);
}

}  // namespace surefield
