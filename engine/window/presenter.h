#pragma once

#include <functional>

#include "engine/splat/tile_lists.h"
#include "engine/window/swapchain.h"

namespace surefield {

/// Shows pictures in a window, with the user interface over them.
class Presenter {
 public:
  /// Takes `surface` over.
  Presenter(gpu::Device& device, VkSurfaceKHR surface);
  ~Presenter();
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;

  /// Stretches a picture (RGBA bytes) over the window of so many pixels, lets `draw` draw over it in
  /// render_pass(), and shows that. A picture of the window's size is shown as it is. Does nothing but
  /// remember the new size where the window has just changed.
  void show(const gpu::Array<glsl::uint>& picture, const ImageSize& size, const Eigen::Vector2i& window,
            const std::function<void(VkCommandBuffer)>& draw);

  /// Runs commands at once, as the user interface needs it to upload its font.
  void run(const std::function<void(VkCommandBuffer)>& record);

  const Swapchain& swapchain() const { return swapchain_; }

 private:
  void begin();
  void finish(VkSemaphore wait, VkSemaphore signal);
  void reserve_image(const ImageSize& size);
  void destroy_image();
  void record_picture(const gpu::Buffer& picture, VkImage target);
  void record_interface(const Swapchain::Target& target, const std::function<void(VkCommandBuffer)>& draw);

  gpu::Device& device_;
  gpu::WindowHandles gpu_;
  Swapchain swapchain_;
  Eigen::Vector2i window_ = Eigen::Vector2i::Zero();  ///< pixels that the swapchain was made for
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkSemaphore free_ = VK_NULL_HANDLE;  ///< the image that is drawn on is no longer shown
  VkFence done_ = VK_NULL_HANDLE;

  // The picture as an image, since only images are stretched and change their order of channels.
  ImageSize image_size_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory image_memory_ = VK_NULL_HANDLE;
};

}  // namespace surefield
