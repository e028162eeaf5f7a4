#include "engine/splat/anchor_motion.h"

#include <algorithm>
#include <cstring>

#include "engine/gpu/recorder.h"

namespace surefield {

namespace {

Eigen::Quaternionf quaternion_of(const glsl::vec4& q) {
  return {q.x, q.y, q.z, q.w};  // w first, there as here
}

}  // namespace

std::vector<glsl::AnchorMotion> to_device(std::span<const Pose> motions) {
  std::vector<glsl::AnchorMotion> result;
  for (const Pose& motion : motions) {
    const auto q = Eigen::Quaterniond(motion.rotation()).normalized().cast<float>();
    const Eigen::Vector3f t = motion.translation().cast<float>();
    result.push_back({{q.w(), q.x(), q.y(), q.z()}, {t.x(), t.y(), t.z()}});
  }
  return result;
}

AnchorMover::AnchorMover(gpu::Device& device)
    : device_(device), pass_(device, gpu::kWorkgroup), motions_(device, "anchor motions") {}

void AnchorMover::move(GaussianMap& map, std::span<const glsl::AnchorMotion> motions) {
  if (map.size() == 0 || motions.empty()) return;
  motions_.upload(motions);
  gpu::Recorder recorder(device_);
  recorder.dispatch(pass_, pass_.groups(map.size()),
                    {.motions = motions_,
                     .anchors = map.anchors,
                     .means = map.means.value,
                     .means_m = map.means.first_moment,
                     .means_v = map.means.second_moment,
                     .rotations = map.rotations.value,
                     .rotations_m = map.rotations.first_moment,
                     .rotations_v = map.rotations.second_moment},
                    {.count = map.size(), .anchors = static_cast<uint32_t>(motions.size())});
  recorder.submit();
}

RecordMover::RecordMover(GaussianMap& map, std::span<const glsl::AnchorMotion> motions)
    : motions_(motions),
      mean_(map.word_of(map.means.value)),
      mean_moments_{map.word_of(map.means.first_moment), map.word_of(map.means.second_moment)},
      rotation_(map.word_of(map.rotations.value)),
      rotation_moments_{map.word_of(map.rotations.first_moment), map.word_of(map.rotations.second_moment)},
      anchor_(map.word_of(map.anchors)) {}

Eigen::Vector3f RecordMover::mean(std::span<const uint32_t> record) const {
  Eigen::Vector3f mean;
  std::memcpy(mean.data(), &record[mean_], sizeof(mean));
  return mean;
}

bool RecordMover::move(std::span<uint32_t> record) const {
  const uint32_t anchor = record[anchor_];
  if (anchor >= motions_.size()) return false;
  const glsl::AnchorMotion& motion = motions_[anchor];
  const glsl::vec3& t = motion.translation;
  const Eigen::Vector3f before = mean(record);
  const Eigen::Vector3f after =
      quaternion_of(motion.rotation).toRotationMatrix() * before + Eigen::Vector3f(t.x, t.y, t.z);
  std::memcpy(&record[mean_], after.data(), sizeof(after));
  Eigen::Vector4f q;  // w first
  std::memcpy(q.data(), &record[rotation_], sizeof(q));
  const Eigen::Quaternionf turned =
      quaternion_of(motion.rotation) * Eigen::Quaternionf(q[0], q[1], q[2], q[3]);
  q << turned.w(), turned.vec();
  std::memcpy(&record[rotation_], q.data(), sizeof(q));
  if ((after - before).norm() <= glsl::MOMENTS_REACH) return true;
  for (uint32_t moment : mean_moments_) std::fill_n(&record[moment], 3, 0u);
  for (uint32_t moment : rotation_moments_) std::fill_n(&record[moment], 4, 0u);
  return true;
}

}  // namespace surefield
