#pragma once

#include <functional>

#include "engine/window/glfw_window.h"
#include "engine/window/presenter.h"

namespace surefield {

/// Dear ImGui in a window: what is drawn over the picture, and whom the mouse and the keys belong to.
class Interface {
 public:
  Interface(const GlfwWindow& window, const gpu::Device& device, Presenter& presenter);
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  /// Lays the interface out: `panels` calls ImGui.
  void lay_out(const std::function<void()>& panels);
  /// Draws what was laid out last.
  void draw(VkCommandBuffer commands) const;

  bool has_mouse() const;
  bool has_keyboard() const;

 private:
  gpu::WindowHandles gpu_;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
};

}  // namespace surefield
