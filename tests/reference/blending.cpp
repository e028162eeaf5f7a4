#include "tests/reference/blending.h"

#include <algorithm>
#include <cmath>

namespace surefield::reference {

namespace {

/// exp(-0.5 d^T Sigma2^-1 d), d from the Gaussian to the pixel.
double falloff(const Projection& projection, int x, int y) {
  const Eigen::Vector2d d = Eigen::Vector2d(x, y) - projection.mean;
  return std::exp(-0.5 * d.dot(projection.conic * d));
}

/// Each contribution's alpha and the transmittance T before it, in the order of blending.
struct Blend {
  std::vector<double> alpha;
  std::vector<double> transmittance;
  double final_transmittance = 1;  ///< behind all of them: 1 - O

  double weight(std::size_t i) const { return alpha[i] * transmittance[i]; }
};

Blend blend(const std::vector<Projection>& projections, const PixelDecisions& decisions,
            const Settings& settings, int x, int y) {
  Blend result;
  for (const Contribution& contribution : decisions.contributions) {
    const Projection& projection = projections[contribution.gaussian];
    result.alpha.push_back(contribution.saturated ? settings.maximum_alpha
                                                  : projection.opacity * falloff(projection, x, y));
    result.transmittance.push_back(result.final_transmittance);
    result.final_transmittance *= 1 - result.alpha.back();
  }
  return result;
}

bool nearly_equal(double a, double b, double relative_margin) {
  return std::abs(a - b) <= relative_margin * std::abs(b);
}

/// Walks one pixel near to far, deciding what is blended and noting decisions that lie within the margins.
class PixelWalk {
 public:
  PixelWalk(const Gaussians& gaussians, const std::vector<Projection>& projections, const Settings& settings)
      : gaussians_(gaussians), projections_(projections), settings_(settings) {}

  /// Considers the next Gaussian, whose opacity times falloff is `alpha`. Returns false where blending stops.
  bool visit(int index, double alpha) {
    const double margin = settings_.edge_margin;
    blend_edge |= nearly_equal(alpha, settings_.minimum_alpha, margin);
    blend_edge |= nearly_equal(alpha, settings_.maximum_alpha, margin);
    if (alpha < settings_.minimum_alpha) return true;
    blend_edge |= projections_[index].near_plane_edge;
    if (projections_[index].decisions.culled) return true;
    check_order(index);

    const bool saturated = alpha > settings_.maximum_alpha;
    if (saturated) alpha = settings_.maximum_alpha;
    const double before = transmittance_;
    transmittance_ *= 1 - alpha;
    // An error e of alpha, relative, is one of e alpha / (1 - alpha) of T.
    const double before_margin = transmittance_margin();
    if (!saturated) amplification_ += alpha / (1 - alpha);
    blend_edge |= nearly_equal(transmittance_, settings_.minimum_transmittance, transmittance_margin());
    if (transmittance_ < settings_.minimum_transmittance) return false;

    median_edge |= nearly_equal(transmittance_, settings_.median_transmittance, transmittance_margin());
    const int position = static_cast<int>(decisions.contributions.size());
    if (decisions.median < 0 && transmittance_ < settings_.median_transmittance) decisions.median = position;
    consider_dominator(position, alpha * before, margin + before_margin);
    decisions.contributions.push_back({index, saturated});
    return true;
  }

  PixelDecisions decisions;
  bool blend_edge = false;
  bool median_edge = false;
  bool dominator_edge = false;

 private:
  double transmittance_margin() const { return settings_.edge_margin * (1 + amplification_); }

  void check_order(int index) {
    // Copies of one Gaussian have the same z in any arithmetic: then the index decides, and there is no
    // doubt.
    if (previous_ >= 0 && gaussians_.means[previous_] != gaussians_.means[index]) {
      blend_edge |= nearly_equal(projections_[index].depth(), projections_[previous_].depth(),
                                 settings_.depth_edge_margin);
    }
    previous_ = index;
  }

  void consider_dominator(int position, double weight, double margin) {
    const bool doubtful = nearly_equal(weight, largest_weight_, margin);
    if (weight > largest_weight_) {
      dominator_edge = doubtful;  // what was in doubt before has been left behind
      largest_weight_ = weight;
      decisions.dominator = position;
    } else {
      dominator_edge |= doubtful;
    }
  }

  const Gaussians& gaussians_;
  const std::vector<Projection>& projections_;
  const Settings& settings_;
  double transmittance_ = 1;
  double amplification_ = 0;  ///< sum of alpha / (1 - alpha): relative error of T per relative error of alpha
  double largest_weight_ = 0;
  int previous_ = -1;
};

}  // namespace

std::vector<int> depth_order(const std::vector<Projection>& projections) {
  std::vector<int> order;
  for (std::size_t i = 0; i < projections.size(); ++i) {
    if (!projections[i].decisions.culled || projections[i].near_plane_edge)
      order.push_back(static_cast<int>(i));
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return projections[a].depth() < projections[b].depth(); });
  return order;
}

PixelDecisions decide_pixel(const Gaussians& gaussians, const std::vector<Projection>& projections,
                            const std::vector<int>& order, const Settings& settings, int x, int y,
                            Images& images) {
  PixelWalk walk(gaussians, projections, settings);
  for (const int index : order) {
    const Projection& projection = projections[index];
    if (!walk.visit(index, projection.opacity * falloff(projection, x, y))) break;
  }
  const std::size_t pixel = static_cast<std::size_t>(y) * images.width + x;
  images.blend_edge[pixel] = walk.blend_edge;
  images.median_edge[pixel] = walk.median_edge;
  images.dominator_edge[pixel] = walk.dominator_edge;
  images.on_edge[pixel] = walk.blend_edge || walk.median_edge || walk.dominator_edge;
  return walk.decisions;
}

void blend_pixel(const std::vector<Projection>& projections, const PixelDecisions& decisions,
                 float sensor_depth, const Settings& settings, int x, int y, Images& images) {
  const std::size_t pixel = static_cast<std::size_t>(y) * images.width + x;
  const Blend blended = blend(projections, decisions, settings, x, y);
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < blended.alpha.size(); ++i) {
    const Projection& projection = projections[decisions.contributions[i].gaussian];
    const double weight = blended.weight(i);
    colour += weight * projection.colour;
    images.opacity[pixel] += weight;
    const double z = projection.depth_at(x, y);
    images.depth[pixel] += weight * z;
    if (valid_depth(sensor_depth))
      images.uncertainty[pixel] += weight * (z - sensor_depth) * (z - sensor_depth);
  }
  colour += (1 - images.opacity[pixel]) * settings.background;
  for (int channel = 0; channel < 3; ++channel) images.colour[pixel * 3 + channel] = colour[channel];
  if (images.opacity[pixel] > 0) images.depth_normalised[pixel] = images.depth[pixel] / images.opacity[pixel];
  if (decisions.median >= 0) {
    images.depth_median[pixel] =
        projections[decisions.contributions[decisions.median].gaussian].depth_at(x, y);
  }
  if (decisions.dominator >= 0) {
    images.dominator[pixel] = decisions.contributions[decisions.dominator].gaussian;
    images.dominator_weight[pixel] = blended.weight(decisions.dominator);
  }
}

void blend_pixel_backward(const std::vector<Projection>& projections, const PixelDecisions& decisions,
                          float sensor_depth, const Settings& settings, int x, int y,
                          const ImageGradients& upstream, std::vector<ProjectionGradient>& gradients) {
  const std::size_t pixel = static_cast<std::size_t>(y) * upstream.width + x;
  const Blend blended = blend(projections, decisions, settings, x, y);
  double opacity = 0, depth = 0;
  for (std::size_t i = 0; i < blended.alpha.size(); ++i) {
    opacity += blended.weight(i);
    depth += blended.weight(i) * projections[decisions.contributions[i].gaussian].depth_at(x, y);
  }
  if (opacity == 0) return;
  const Eigen::Vector3d g_colour(&upstream.colour[pixel * 3]);
  // d(D_alpha / O) = (dD_alpha - N dO) / O
  const double g_depth = upstream.depth[pixel] + upstream.depth_normalised[pixel] / opacity;
  const double g_opacity =
      upstream.opacity[pixel] - upstream.depth_normalised[pixel] * depth / (opacity * opacity);
  const double g_uncertainty = valid_depth(sensor_depth) ? upstream.uncertainty[pixel] : 0;
  const double sensor = valid_depth(sensor_depth) ? sensor_depth : 0;

  // L = sum_i alpha_i T_i payload_i + T_final g_colour . background; `behind` is what follows i in that sum.
  double behind = blended.final_transmittance * g_colour.dot(settings.background);
  for (int i = static_cast<int>(blended.alpha.size()) - 1; i >= 0; --i) {
    const Contribution& contribution = decisions.contributions[i];
    const Projection& projection = projections[contribution.gaussian];
    ProjectionGradient& gradient = gradients[contribution.gaussian];
    const double weight = blended.weight(i);
    const double z = projection.depth_at(x, y);
    gradient.colour += weight * g_colour;
    const Eigen::Vector2d d = Eigen::Vector2d(x, y) - projection.mean;
    double g_z = weight * (g_depth + 2 * g_uncertainty * (z - sensor));
    if (i == decisions.median) g_z += upstream.depth_median[pixel];
    gradient.depth += g_z;
    gradient.slope += g_z * d;
    gradient.mean -= g_z * projection.slope;

    const double payload = g_colour.dot(projection.colour) + g_opacity + g_depth * z +
                           g_uncertainty * (z - sensor) * (z - sensor);
    const double g_alpha = blended.transmittance[i] * payload - behind / (1 - blended.alpha[i]);
    behind += weight * payload;
    if (contribution.saturated) continue;
    gradient.opacity += g_alpha * falloff(projection, x, y);
    gradient.mean += g_alpha * blended.alpha[i] * projection.conic * d;
    gradient.conic -= 0.5 * g_alpha * blended.alpha[i] * d * d.transpose();
  }
}

}  // namespace surefield::reference
