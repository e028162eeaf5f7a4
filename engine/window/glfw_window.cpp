#include "engine/window/glfw_window.h"

#include "engine/gpu/error.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr int kFirstWidth = 1280;  // screen coordinates
constexpr int kFirstHeight = 800;
constexpr double kClick = 4;  // screen coordinates that the mouse may move between press and release

std::string last_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "the reason is not known";
}

/// GLFW is started once and ended with the program.
bool start_glfw() {
  static const bool started = glfwInit() == GLFW_TRUE;
  return started;
}

}  // namespace

std::string glfw_problem() {
  if (!start_glfw()) return "there is no display: " + last_error();
  if (!glfwVulkanSupported()) return "Vulkan cannot show windows on this display";
  return "";
}

GlfwWindow::GlfwWindow(const std::string& title, double scale) : scale_(static_cast<float>(scale)) {
  if (const std::string problem = glfw_problem(); !problem.empty()) throw InputError(problem);
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, scale_ > 0 ? GLFW_FALSE : GLFW_TRUE);
  const double size = scale_ > 0 ? scale_ : 1;
  window_ = glfwCreateWindow(static_cast<int>(size * kFirstWidth), static_cast<int>(size * kFirstHeight),
                             title.c_str(), nullptr, nullptr);
  if (!window_) throw InputError("no window can be opened: " + last_error());
  glfwSetWindowUserPointer(window_, this);
  listen();
}

GlfwWindow::~GlfwWindow() {
  glfwDestroyWindow(window_);
}

GlfwWindow& GlfwWindow::of(GLFWwindow* window) {
  return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
}

void GlfwWindow::listen() {
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
    of(w).input_.any = true;
    if (action != GLFW_RELEASE) of(w).input_.presses.push_back({key, mods});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
    GlfwWindow& window = of(w);
    window.input_.any = true;
    const bool down = action == GLFW_PRESS && !window.ui_has_mouse_;
    if (button == GLFW_MOUSE_BUTTON_LEFT)
      window.press_left(down);
    else
      window.right_ = down;
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    GlfwWindow& window = of(w);
    window.input_.any = true;
    const Eigen::Vector2d moved = Eigen::Vector2d(x, y) - window.cursor_;
    window.cursor_ += moved;
    window.dragged_ += moved.lpNorm<1>();
    if (window.left_) window.input_.drag_left += moved;
    if (window.right_) window.input_.drag_right += moved;
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
    of(w).input_.any = true;
    if (!of(w).ui_has_mouse_) of(w).input_.scroll += y;
  });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { of(w).input_.any = true; });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { of(w).input_.any = true; });
  glfwSetWindowIconifyCallback(window_, [](GLFWwindow* w, int) { of(w).input_.any = true; });
}

void GlfwWindow::press_left(bool down) {
  if (down) dragged_ = 0;
  if (left_ && !down && dragged_ < kClick) input_.clicks.push_back(to_pixels(cursor_));
  left_ = down;
}

Eigen::Vector2d GlfwWindow::to_pixels(const Eigen::Vector2d& coordinates) const {
  Eigen::Vector2i size;
  glfwGetWindowSize(window_, &size.x(), &size.y());
  return coordinates.cwiseProduct(pixels().cast<double>()).cwiseQuotient(size.cwiseMax(1).cast<double>());
}

std::vector<std::string> GlfwWindow::instance_extensions() const {
  uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  return {names, names + count};
}

VkSurfaceKHR GlfwWindow::create_surface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  gpu::check(glfwCreateWindowSurface(instance, window_, nullptr, &surface), "creating the window's surface");
  return surface;
}

UserInput GlfwWindow::wait(double seconds, bool ui_has_mouse) {
  ui_has_mouse_ = ui_has_mouse;
  if (seconds > 0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  UserInput input;
  std::swap(input, input_);
  return input;
}

Eigen::Vector2i GlfwWindow::pixels() const {
  Eigen::Vector2i size;
  glfwGetFramebufferSize(window_, &size.x(), &size.y());
  return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) ? Eigen::Vector2i(0, 0) : size;
}

Eigen::Vector2d GlfwWindow::cursor() const {
  return to_pixels(cursor_);
}

float GlfwWindow::scale() const {
  if (scale_ > 0) return scale_;
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  return x;
}

}  // namespace surefield
