#include "engine/synth/synthetic_dataset.h"

#include <utility>

#include "engine/io/error.h"

namespace surefield {

SyntheticDataset::SyntheticDataset(const SynthSettings& settings)
    : settings_(settings), room_(settings.seed) {
  if (settings.width < 1 || settings.height < 1 || settings.frames < 1) {
    throw InputError("synthetic sequence: width, height and frames must be at least 1");
  }
  for (int i = 0; i < size(); ++i) {
    ground_truth_.push_back({timestamp(i), room_.world_to_camera(timestamp(i)).inverse()});
  }
}

Intrinsics SyntheticDataset::intrinsics() const {
  const double focal_length = 0.85 * settings_.width;
  return {settings_.width,
          settings_.height,
          focal_length,
          focal_length,
          0.5 * (settings_.width - 1),
          0.5 * (settings_.height - 1)};
}

LoadedFrame SyntheticDataset::load(int i) const {
  Frame frame = room_.render({intrinsics(), room_.world_to_camera(timestamp(i))});
  frame.index = i;
  frame.timestamp = timestamp(i);
  return {std::move(frame), ""};
}

}  // namespace surefield
