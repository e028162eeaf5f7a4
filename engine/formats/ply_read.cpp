#include <optional>
#include <string>
#include <vector>

#include "engine/formats/ply.h"
#include "engine/formats/ply_compressed.h"
#include "engine/formats/ply_header.h"
#include "engine/formats/ply_records.h"
#include "engine/formats/usable_gaussians.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

/// Where in a vertex the values stand that a Gaussian needs, in the order of GaussianFields.
struct GaussianLayout {
  int sh_degree = 0;
  std::vector<std::size_t>
      columns;  ///< mean, log scale, rotation, opacity, then SH coefficient by coefficient
  std::optional<std::size_t> uncertainty, sampling;
};

std::size_t column(const std::filesystem::path& file, const PlyElement& vertices, const std::string& name) {
  const auto found = vertices.find(name);
  if (!found) throw InputError(file, "has no property " + name + "; is it a Gaussian splatting PLY?");
  return *found;
}

int infer_sh_degree(const std::filesystem::path& file, const PlyElement& vertices) {
  int rest = 0;
  for (const PlyProperty& property : vertices.properties)
    rest += property.name.starts_with("f_rest_") ? 1 : 0;
  for (int degree = 0; degree <= 3; ++degree) {
    if (rest == 3 * (sh_coefficients(degree) - 1)) return degree;
  }
  throw InputError(file,
                   "has " + std::to_string(rest) + " properties f_rest_*; only 0, 9, 24 or 45 are possible");
}

/// Refuses meshes and points, which have none of what makes a Gaussian.
void require_gaussians(const std::filesystem::path& file, const PlyHeader& header) {
  const PlyElement& vertices = header.vertices();
  for (const char* name : {"scale_0", "rot_0", "f_dc_0"})
    if (vertices.find(name)) return;
  for (const PlyElement& element : header.elements) {
    if (element.name != "face" || element.count == 0) continue;
    throw InputError(file, "is a triangle mesh (" + std::to_string(element.count) +
                               " faces), not a map of Gaussians; surefield export --mesh and surefield eval "
                               "--mesh take it, maps are made by surefield run");
  }
  throw InputError(file,
                   "is a point cloud without Gaussians: its vertices have no scale_0, rot_0 and f_dc_0; "
                   "give the map that it was made from, as map.ply of surefield run");
}

GaussianLayout find_layout(const std::filesystem::path& file, const PlyElement& vertices) {
  GaussianLayout layout;
  layout.sh_degree = infer_sh_degree(file, vertices);
  const auto add = [&](const std::string& name) { layout.columns.push_back(column(file, vertices, name)); };
  for (const char* name : {"x", "y", "z", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3",
                           "opacity", "f_dc_0", "f_dc_1", "f_dc_2"}) {
    add(name);
  }
  const int rest = sh_coefficients(layout.sh_degree) - 1;
  for (int k = 0; k < rest; ++k) {
    for (int channel = 0; channel < 3; ++channel) add("f_rest_" + std::to_string(channel * rest + k));
  }
  layout.uncertainty = vertices.find("uncertainty");
  layout.sampling = vertices.find("sampling");
  return layout;
}

void append(const std::vector<float>& values, GaussianCloud& cloud) {
  cloud.means.emplace_back(values[0], values[1], values[2]);
  cloud.log_scales.emplace_back(values[3], values[4], values[5]);
  cloud.rotations.emplace_back(values[6], values[7], values[8], values[9]);
  cloud.opacity_logits.push_back(values[10]);
  cloud.sh.insert(cloud.sh.end(), values.begin() + 11, values.end());
}

}  // namespace

PlyCloud read_ply(const std::filesystem::path& file) {
  const PlyHeader header = read_ply_header(file);
  if (header.is_compressed()) return read_compressed_ply(file, header);
  const PlyElement& vertices = header.vertices();
  require_gaussians(file, header);
  const GaussianLayout layout = find_layout(file, vertices);
  PlyCloud result;
  result.cloud.sh_degree = layout.sh_degree;
  PlyRecordReader reader(file, header);
  PlyRecord record;
  std::vector<float> values(layout.columns.size());
  for (std::size_t i = 0; i < vertices.count; ++i) {
    reader.next(vertices, record);
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = static_cast<float>(record.values[layout.columns[k]]);
    }
    append(values, result.cloud);
    const auto extra = [&](const std::optional<std::size_t>& property) {
      return property ? static_cast<float>(record.values[*property]) : 0.0f;
    };
    result.cloud.uncertainty.push_back(extra(layout.uncertainty));
    result.cloud.sampling.push_back(extra(layout.sampling));
    result.cloud.anchors.push_back(0);
  }
  const LeftOutGaussians left_out = keep_usable(result.cloud);
  result.dropped = left_out.broken;
  result.invisible = left_out.invisible;
  return result;
}

}  // namespace surefield
