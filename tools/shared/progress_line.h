#pragma once

#include <chrono>
#include <string>

namespace surefield {

/// Draws a bar of `fraction` (clamped to [0, 1]) over the current line of the terminal on stderr, between
/// `label` and `text`.
void draw_bar(const std::string& label, double fraction, const std::string& text);

/// Shows on stderr how far a long task is: a bar that is drawn again and again where that is a terminal, else
/// nothing.
class ProgressLine {
 public:
  explicit ProgressLine(std::string label);
  /// Ends the line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// `fraction` done, in [0, 1] (below 0: unknown), and what to say beside the bar.
  void show(double fraction, const std::string& text);

 private:
  std::string label_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace surefield
