#include "engine/formats/glb.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/formats/gaussian_order.h"
#include "engine/formats/glb_file.h"
#include "engine/formats/rounded_values.h"
#include "engine/formats/turned_axes.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr int kPoints = 0, kTriangles = 4;  // what a primitive may be made of
constexpr const char* kSplatting = "KHR_gaussian_splatting";
constexpr const char* kUnlit = "KHR_materials_unlit";

/// Unit quaternions x, y, z, w.
std::vector<float> turned_rotations(const GaussianCloud& cloud) {
  std::vector<float> values;
  for (const Eigen::Vector4f& rotation : cloud.rotations) {
    const Eigen::Vector4f q = rotation.stableNormalized();
    for (int axis = 0; axis < 3; ++axis)
      values.push_back(q[axis + 1] * kTurnedAxes[static_cast<std::size_t>(axis)]);
    values.push_back(q[0]);
  }
  return values;
}

std::vector<float> linear_scales(const GaussianCloud& cloud) {
  std::vector<float> values;
  for (const Eigen::Vector3f& log_scale : cloud.log_scales)
    for (float value : log_scale)
      values.push_back(std::min(std::exp(value), std::numeric_limits<float>::max()));
  return values;
}

std::vector<float> opacities_of(const GaussianCloud& cloud) {
  std::vector<float> values;
  for (float logit : cloud.opacity_logits) values.push_back(opacity_of(logit));
  return values;
}

/// One SH coefficient of all Gaussians.
std::vector<float> turned_coefficient(const GaussianCloud& cloud, std::size_t coefficient) {
  const auto coefficients = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree));
  const float sign = coefficient == 0 ? 1 : kTurnedHarmonics[coefficient - 1];
  std::vector<float> values;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      values.push_back(sign * cloud.sh[(i * coefficients + coefficient) * 3 + channel]);
  return values;
}

/// What programs show that take the Gaussians for points.
std::vector<std::array<float, 4>> point_colours(const GaussianCloud& cloud) {
  const auto stride = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree)) * 3;
  std::vector<std::array<float, 4>> colours;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float* sh = cloud.sh.data() + i * stride;
    const auto channel = [&](int c) { return kHarmonic0 * sh[c] + 0.5f; };
    colours.push_back({channel(0), channel(1), channel(2), opacity_of(cloud.opacity_logits[i])});
  }
  return colours;
}

nlohmann::json splat_attributes(GlbFile& glb, const GaussianCloud& cloud) {
  const std::string prefix = std::string(kSplatting) + ":";
  nlohmann::json attributes = {{"POSITION", glb.add_positions(cloud.means)},
                               {"COLOR_0", glb.add_colours(point_colours(cloud))},
                               {prefix + "ROTATION", glb.add_floats(turned_rotations(cloud), "VEC4")},
                               {prefix + "SCALE", glb.add_floats(linear_scales(cloud), "VEC3")},
                               {prefix + "OPACITY", glb.add_floats(opacities_of(cloud), "SCALAR")}};
  std::size_t next = 0;
  for (int degree = 0; degree <= cloud.sh_degree; ++degree)
    for (int k = 0; k <= 2 * degree; ++k)
      attributes[prefix + "SH_DEGREE_" + std::to_string(degree) + "_COEF_" + std::to_string(k)] =
          glb.add_floats(turned_coefficient(cloud, next++), "VEC3");
  return attributes;
}

}  // namespace

void write_glb(const std::filesystem::path& file, const GaussianCloud& cloud) {
  if (!cloud.is_consistent()) throw UsageError("write_glb: the arrays of the cloud differ in length");
  const GaussianCloud finite = select(cloud, finite_gaussians(cloud));
  GlbFile glb;
  glb.use_extension(kSplatting);
  if (finite.size() > 0) {
    const nlohmann::json splatting = {{"kernel", "ellipse"},
                                      {"colorSpace", "srgb_rec709_display"},
                                      {"projection", "perspective"},
                                      {"sortingMethod", "cameraDistance"}};
    glb.set_mesh("map", {{"mode", kPoints},
                         {"attributes", splat_attributes(glb, finite)},
                         {"extensions", {{kSplatting, splatting}}}});
  }
  glb.write(file);
}

void write_glb(const std::filesystem::path& file, const TriangleMesh& mesh, const MeshTurn& turn) {
  if (turn.axes == MeshAxes::ZUp) throw InputError(file, "cannot have z upwards: in glTF, y is up");
  if (!mesh.colours.empty() && mesh.colours.size() != mesh.vertices.size())
    throw UsageError("write_glb: the mesh has more or fewer colours than vertices");
  GlbFile glb;
  if (!mesh.triangles.empty()) {
    nlohmann::json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}};
    nlohmann::json attributes = {{"POSITION", glb.add_positions(mesh.vertices)}};
    if (!mesh.colours.empty()) {
      std::vector<std::array<float, 4>> colours;
      for (const Eigen::Vector3f& colour : mesh.colours)
        colours.push_back({colour[0], colour[1], colour[2], 1});
      attributes["COLOR_0"] = glb.add_colours(colours);
      material["extensions"][kUnlit] = nlohmann::json::object();
      glb.use_extension(kUnlit);
    }
    glb.set_material(std::move(material));
    glb.set_mesh("mesh", {{"mode", kTriangles},
                          {"attributes", attributes},
                          {"indices", glb.add_indices(mesh.triangles)},
                          {"material", 0}});
    if (turn.axes == MeshAxes::YUp) glb.turn_mesh(turn.world_to_file);
  }
  glb.write(file);
}

}  // namespace surefield
