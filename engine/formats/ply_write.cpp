#include <bit>
#include <vector>

#include "engine/formats/gaussian_order.h"
#include "engine/formats/ply.h"
#include "engine/formats/rounded_values.h"
#include "engine/io/files.h"
#include "engine/types/error.h"

static_assert(std::endian::native == std::endian::little,
              "PLY files are written in the byte order of the machine");

namespace surefield {

namespace {

void write_header(std::ostream& stream, const GaussianCloud& cloud) {
  stream << "ply\nformat binary_little_endian 1.0\nelement vertex " << cloud.size() << "\n";
  const auto property = [&](const std::string& name) { stream << "property float " << name << "\n"; };
  const auto properties = [&](const std::string& prefix, int count) {
    for (int i = 0; i < count; ++i) property(prefix + std::to_string(i));
  };
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) property(name);
  properties("f_dc_", 3);
  properties("f_rest_", 3 * (sh_coefficients(cloud.sh_degree) - 1));
  property("opacity");
  properties("scale_", 3);
  properties("rot_", 4);
  for (const char* name : {"uncertainty", "sampling"})
    property(name);  // not part of the usual layout; other programs go past them
  stream << "end_header\n";
}

/// One Gaussian as stored; `record` is reused.
void fill_record(const GaussianCloud& cloud, std::size_t i, std::vector<float>& record) {
  const auto coefficients = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree));
  const float* sh = cloud.sh.data() + i * coefficients * 3;
  record.clear();
  record.insert(record.end(), cloud.means[i].begin(), cloud.means[i].end());
  record.insert(record.end(), 3, 0.0f);  // normals, which nobody uses and every tool expects
  record.insert(record.end(), sh, sh + 3);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t k = 1; k < coefficients; ++k) record.push_back(sh[k * 3 + channel]);
  }
  record.push_back(cloud.opacity_logits[i]);
  record.insert(record.end(), cloud.log_scales[i].begin(), cloud.log_scales[i].end());
  record.insert(record.end(), cloud.rotations[i].begin(), cloud.rotations[i].end());
  record.push_back(cloud.uncertainty[i]);
  record.push_back(cloud.sampling[i]);
}

}  // namespace

void write_ply(const std::filesystem::path& file, const GaussianCloud& cloud) {
  if (!cloud.is_consistent()) throw UsageError("write_ply: the arrays of the cloud differ in length");
  write_file(file, [&](std::ostream& stream) {
    write_header(stream, cloud);
    std::vector<float> record;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      fill_record(cloud, i, record);
      stream.write(reinterpret_cast<const char*>(record.data()),
                   static_cast<std::streamsize>(record.size() * sizeof(float)));
    }
  });
}

void write_point_cloud(const std::filesystem::path& file, const GaussianCloud& cloud) {
  if (!cloud.is_consistent()) throw UsageError("write_point_cloud: the arrays of the cloud differ in length");
  const std::vector<std::size_t> finite = finite_gaussians(cloud);
  const auto stride = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree)) * 3;
  write_file(file, [&](std::ostream& stream) {
    stream
        << "ply\nformat binary_little_endian 1.0\nelement vertex " << finite.size()
        << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green"
           "\nproperty uchar blue\nproperty float opacity\nend_header\n";
    for (std::size_t i : finite) {
      stream.write(reinterpret_cast<const char*>(cloud.means[i].data()), 3 * sizeof(float));
      for (std::size_t channel = 0; channel < 3; ++channel)
        stream.put(static_cast<char>(to_byte(255 * (kHarmonic0 * cloud.sh[i * stride + channel] + 0.5f))));
      const float opacity = opacity_of(cloud.opacity_logits[i]);
      stream.write(reinterpret_cast<const char*>(&opacity), sizeof(opacity));
    }
  });
}

}  // namespace surefield
