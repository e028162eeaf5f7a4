#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "engine/types/gaussian_cloud.h"
#include "tests/tools/support.h"
#include "tests/tools/virtual_screen.h"

namespace surefield::test {

/// A heap of 400 Gaussians of all colours around a place 2 m before the first camera.
GaussianCloud heap();

/// Waits for something, at most half a minute; returns whether it has happened.
bool wait_for(const std::function<bool()>& happened);

/// Whether this machine and this build can show a window; says so where they cannot.
bool can_show_windows();

/// A viewer on a virtual screen, and what is done to it.
class ViewSession {
 public:
  /// How large things are, pixels.
  struct Sizes {
    cv::Size screen{900, 600};
    cv::Size window{700, 450};  ///< none: as it opens
  };

  ViewSession(const TemporaryFolder& folder, std::vector<std::string> arguments, const Sizes& sizes);
  ViewSession(const TemporaryFolder& folder, std::vector<std::string> arguments)
      : ViewSession(folder, std::move(arguments), Sizes{}) {}

  /// Does something that changes the picture, and waits until it has changed; returns whether it has.
  bool changes(const std::string& act);

  /// Saves a screenshot, and returns it.
  cv::Mat save();
  /// The same, where the window must show what is saved, pixel by pixel.
  cv::Mat screenshot();
  /// The camera of the last screenshot, as a file.
  std::filesystem::path camera() const { return folder_ / (stem() + ".json"); }

  /// Does something upon which the program prints a line that begins with `word`; returns the line, or "".
  std::string line_after(const std::string& act, const std::string& word);

  /// Closes the window; returns the exit code.
  int close();

  /// Waits until the screen rests, and returns what it shows.
  cv::Mat settle() const;

  void act(const std::string& words) const { screen_.act(words); }
  const std::string& window() const { return window_; }
  const VirtualScreen& screen() const { return screen_; }
  const Program& program() const { return program_; }

 private:
  /// Of the last screenshot's files.
  std::string stem() const;

  const TemporaryFolder& folder_;
  VirtualScreen screen_;
  Program program_;
  std::string window_;
  int screenshots_ = 0;
};

}  // namespace surefield::test
