#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/splat/requests.h"
#include "engine/types/camera.h"
#include "engine/types/depth_model.h"
#include "engine/types/gaussian_cloud.h"
#include "engine/types/render_images.h"

namespace surefield {

/// The Gaussian field and everything that is done to it, in a handful of verbs on plain data. All heavy work
/// runs as compute kernels on a Vulkan device; gpu::Error is thrown when that fails. Not thread-safe.
class SplatEngine {
 public:
  explicit SplatEngine(const EngineOptions& options = {});
  ~SplatEngine();

  /// Takes a frame in, or releases it. The images of a few frames are on the device, those of the others wait
  /// in host memory, without loss, until they are asked for.
  FrameHandle load(const FrameView& frame);
  void release(FrameHandle frame);
  /// From here on the frame shows nothing in the pixels that are flagged, row-major: mapping and alignment do
  /// not compare them. Throws UsageError for a frame that is not held, or of another size.
  void hide(FrameHandle frame, std::span<const uint8_t> pixels);

  /// Replaces the map, adds Gaussians to it, reads it back. The depth of a Gaussian over its footprint comes
  /// with the map, and not with each verb: Gaussians that were optimised with the one are wrong in the other.
  void assign(const GaussianCloud& cloud, DepthModel depth_model = DepthModel::Plane);
  void insert(const GaussianCloud& cloud);
  GaussianCloud map() const;
  uint32_t size() const;
  /// Gaussians on the device; see set_map_budget().
  uint32_t device_size() const;

  /// Sets how much device memory the Gaussians may take, with all that is kept for each of them. The map is
  /// then in two parts: what focus() and recall() ask for is on the device, and everything else waits in host
  /// memory, as it was. All verbs but map(), size() and render_whole() work on the part on the device.
  void set_map_budget(uint64_t bytes);
  /// Whether the whole map is on the device, with room for so many more Gaussians.
  bool is_whole(uint32_t births = 0) const;
  /// Brings back the Gaussians near these places: within half a metre, and up to half a metre more. Returns
  /// false, with nothing done, when there is no room for them.
  bool recall(const WorldPoints& points);
  /// Has on the device what is near the places of regions[0], and of as many more regions, in this order, as
  /// there is room for beside so many `births`; moves the rest to host memory where it is worth it. Returns
  /// how many regions are on the device: at least the first, of which there may be a part, nearest its
  /// places, when there is no room for all of it.
  int focus(std::span<const WorldPoints> regions, uint32_t births);

  /// Moves the whole map with the keyframes that its Gaussians were born in: motions[a], a motion in the
  /// world, is that of the Gaussians whose anchor is a (GaussianCloud::anchors); those of later anchors stay.
  void move(std::span<const Pose> motions);

  /// Renders a camera; with sensor depth (metres, row-major), also the uncertainty.
  RenderImages render(const Camera& camera) const;
  RenderImages render(const Camera& camera, std::span<const float> sensor_depth) const;
  /// Renders the whole map: for that time it is on the device beyond the budget.
  RenderImages render_whole(const Camera& camera) const;

  /// Finds the pose of a frame in the fixed map, starting from that of `start`. Gauss-Newton aligns it to the
  /// first four `references` too; Adam does not. Throws UsageError where one is of another size.
  TrackingResult track(FrameHandle frame, const Camera& start, const TrackingSettings& settings,
                       std::span<const TrackingReference> references = {});

  /// Finds the pose of a frame relative to one `reference` alone, by Gauss-Newton from that of `start`,
  /// coarse to fine: the map has no part in it. Throws UsageError where the two are not of one size.
  PairAlignment align(FrameHandle frame, const Camera& start, const TrackingReference& reference,
                      const TrackingSettings& settings);

  /// The frame that was tracked last stays: while the map does not change, the next ones are aligned to the
  /// render that its tracking ended with, where they are near.
  void keep_render();

  /// Optimises the map over views[order[0]], views[order[1]], ..., one step each, and the poses of the views
  /// that ask for it. `pixel`, the metres that one covers at the scene's distance, scales the rate of the
  /// centres. Where `limit` is reached, the steps that remain are left out.
  MappingResult optimise(std::span<MappingView> views, std::span<const int> order,
                         const MappingSettings& settings, double pixel, const MappingLimit& limit = {});

  /// Computes the uncertainty of the Gaussians that dominate pixels of the views (paper eq. 13) and lowers
  /// the opacity of the uncertain ones. Does nothing where `settings` says that none is judged.
  JudgeResult judge(std::span<const MappingView> views, const MappingSettings& settings);

  /// Splits, clones and removes; the statistics that decide are those gathered since the last call.
  DensifyResult densify(const DensifySettings& settings);

  EngineReport report() const;
  /// Device memory in use now.
  uint64_t device_bytes() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace surefield
