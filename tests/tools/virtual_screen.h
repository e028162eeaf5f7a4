#pragma once

#include <sys/types.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace surefield::test {

/// A screen that nobody sees (Xvfb), with a keyboard and a mouse (xdotool). While it exists, programs started
/// from here show their windows on it.
class VirtualScreen {
 public:
  /// Whether the machine has what that takes.
  static bool available();

  /// Its memory is a file in `folder`. Throws std::runtime_error where it does not start.
  VirtualScreen(const std::filesystem::path& folder, int width, int height);
  ~VirtualScreen();
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;

  /// What it shows now: CV_8UC3, RGB.
  cv::Mat picture() const;

  /// The window with this text in its title, which is waited for.
  std::string find_window(const std::string& title) const;
  /// Runs `xdotool` with these words; returns what it prints.
  std::string act(const std::string& words) const;

 private:
  std::filesystem::path memory_;
  pid_t server_ = -1;
};

}  // namespace surefield::test
