#pragma once

#include <vulkan/vulkan.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/gpu/device.h"

namespace surefield {

/// The images of a window, with what a render pass needs to draw on them.
class Swapchain {
 public:
  /// One image of the window.
  struct Target {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    VkSemaphore drawn = VK_NULL_HANDLE;  ///< signalled when it may be shown
  };

  /// Takes `surface` over. Throws gpu::Error(MissingFeature) where the device cannot present on it.
  Swapchain(const gpu::Device& device, VkSurfaceKHR surface);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  /// Makes the images anew, for a window of so many pixels. The device must be idle.
  void resize(const Eigen::Vector2i& pixels);

  /// The index of the next image to draw on, which `free` says is no longer shown; nullopt where the window
  /// has changed: resize().
  std::optional<uint32_t> acquire(VkSemaphore free);
  /// Shows an image once it is drawn; false where the window has changed.
  bool present(uint32_t index);

  const Target& target(uint32_t index) const { return targets_[index]; }
  uint32_t images() const { return static_cast<uint32_t>(targets_.size()); }
  VkExtent2D extent() const { return extent_; }
  VkFormat format() const { return format_.format; }
  /// Draws on an image in the layout for that, and leaves it ready to be shown.
  VkRenderPass render_pass() const { return render_pass_; }

 private:
  void choose_format();
  void create_render_pass();
  void create_targets();
  void destroy_targets();

  gpu::WindowHandles gpu_;
  VkSurfaceKHR surface_;
  VkSurfaceFormatKHR format_{};
  VkRenderPass render_pass_ = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  std::vector<Target> targets_;
};

}  // namespace surefield
