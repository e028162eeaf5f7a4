#include "engine/sources/stamp_notes.h"

#include <fmt/format.h>

#include <algorithm>

namespace surefield {

namespace {

constexpr double kNearestPose = 0.02;  // seconds between a frame and its true pose

/// "12.5 to 40" of stamps that are sorted, or nearly so.
std::string range_text(double first, double last) {
  return fmt::format("{:.2f} to {:.2f}", first, last);
}

/// Whether none of the true poses is near a frame, and by how much; empty where one is.
std::string note_on_truth(const std::vector<double>& frames, const Trajectory& truth) {
  std::vector<double> stamps;
  for (const StampedPose& pose : truth)
    if (pose.is_finite()) stamps.push_back(pose.timestamp);
  std::sort(stamps.begin(), stamps.end());
  if (stamps.empty()) return "the ground truth knows no pose";
  for (const double frame : frames) {
    const auto next = std::lower_bound(stamps.begin(), stamps.end(), frame - kNearestPose);
    if (next != stamps.end() && *next <= frame + kNearestPose) return {};
  }
  return fmt::format(
      "no pose of the ground truth is near a frame: its stamps are {} s, those of the frames {} s; the "
      "clocks "
      "differ by {:.2f} s",
      range_text(stamps.front(), stamps.back()), range_text(frames.front(), frames.back()),
      frames.front() - stamps.front());
}

}  // namespace

std::vector<std::string> notes_on_stamps(const std::vector<double>& stamps, const Trajectory* truth) {
  std::vector<std::string> notes;
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < stamps.size(); ++i) repeated += stamps[i] == stamps[i - 1] ? 1 : 0;
  if (repeated > 0)
    notes.push_back(
        fmt::format("{} of {} frames have the time stamp of the frame before", repeated, stamps.size()));
  const std::string note = truth ? note_on_truth(stamps, *truth) : "";
  if (!note.empty()) notes.push_back(note);
  return notes;
}

}  // namespace surefield
