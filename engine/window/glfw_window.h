#pragma once

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace surefield {

/// What the user did since it was asked last.
struct UserInput {
  struct Press {
    int key = 0;  ///< GLFW_KEY_...
    int mods = 0;
  };
  std::vector<Press> presses;                           ///< keys pressed or repeated
  Eigen::Vector2d drag_left = Eigen::Vector2d::Zero();  ///< pixels that the mouse moved with that button down
  Eigen::Vector2d drag_right = Eigen::Vector2d::Zero();  ///< or the middle one
  std::vector<Eigen::Vector2d> clicks;  ///< places of the window, in its pixels, where the left button was
                                        ///< pressed and let go of without a drag between
  double scroll = 0;
  bool any = false;  ///< whether anything happened at all, be it that the mouse moved
};

/// A window of the operating system, without anything in it, and hidden at first. Only on the main thread;
/// one at a time.
class GlfwWindow {
 public:
  /// `scale`: see scale(); 0: as the screen asks. Throws InputError where no window can be shown.
  GlfwWindow(const std::string& title, double scale);
  ~GlfwWindow();
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  /// Until now it was hidden.
  void show() { glfwShowWindow(window_); }

  /// The extensions that an instance for it must have.
  std::vector<std::string> instance_extensions() const;
  /// A surface for it; the caller destroys it.
  VkSurfaceKHR create_surface(VkInstance instance) const;

  /// Waits for events, `seconds` at most, and returns what they were. Drags and scrolls over what belongs to
  /// the user interface (`ui_has_mouse`) are left out.
  UserInput wait(double seconds, bool ui_has_mouse);
  bool is_down(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }

  /// Its size in pixels; 0 x 0 while minimised.
  Eigen::Vector2i pixels() const;
  /// How many times larger than usual text and controls should be.
  float scale() const;
  /// Where the mouse is, in pixels of the window.
  Eigen::Vector2d cursor() const;
  bool should_close() const { return glfwWindowShouldClose(window_); }
  void close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
  GLFWwindow* handle() const { return window_; }

 private:
  void listen();
  void press_left(bool down);
  Eigen::Vector2d to_pixels(const Eigen::Vector2d& coordinates) const;
  static GlfwWindow& of(GLFWwindow* window);

  GLFWwindow* window_ = nullptr;
  float scale_ = 0;  ///< 0: as the screen asks
  UserInput input_;
  Eigen::Vector2d cursor_ = Eigen::Vector2d::Zero();
  bool left_ = false;
  double dragged_ = 0;  ///< screen coordinates that the mouse moved since the left button was pressed
  bool right_ = false;
  bool ui_has_mouse_ = false;
};

/// Why GLFW can show no window here; empty where it can.
std::string glfw_problem();

}  // namespace surefield
