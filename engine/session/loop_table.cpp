#include "engine/session/loop_table.h"

#include <fmt/format.h>

#include <numbers>

namespace surefield {

namespace {

/// The upper triangle by rows, in one cell.
std::string information_text(const Matrix6& information) {
  std::string text;
  for (int row = 0; row < information.rows(); ++row)
    for (int column = row; column < information.cols(); ++column)
      text += fmt::format("{}{:.6g}", text.empty() ? "" : " ", information(row, column));
  return text;
}

bool counts(const Loop& loop) {
  return loop.verdict == LoopVerdict::Accepted || loop.verdict == LoopVerdict::Agreed;
}

}  // namespace

std::string loops_csv(const std::vector<Loop>& loops, const std::vector<int>& frames) {
  std::string text =
      "from,to,similarity,inliers,overlap,agreeing,see_through,correction_cm,correction_deg,correction_px,"
      "accepted,why,tx,ty,tz,qx,qy,qz,qw,information\n";
  for (const Loop& loop : loops) {
    const RelativePose& measured = loop.measured;
    const Eigen::Vector3d t = measured.pose.translation();
    const Eigen::Quaterniond q(measured.pose.rotation());
    text += fmt::format(
        "{},{},{:.4f},{},{:.4f},{:.4f},{:.4f},{:.3f},{:.4f},{:.3f},{},{},{:.7g},{:.7g},{:.7g},{:.9g},{:.9g},"
        "{:.9g},{:.9g},{}\n",
        frames[static_cast<std::size_t>(measured.from)], frames[static_cast<std::size_t>(measured.to)],
        loop.similarity, loop.inliers, loop.depth.shared, loop.depth.agreeing, loop.depth.seen_through,
        100 * loop.correction_position, loop.correction_rotation * 180 / std::numbers::pi,
        loop.correction_pixels, counts(loop) ? 1 : 0, name_of(loop.verdict), t.x(), t.y(), t.z(), q.x(), q.y(),
        q.z(), q.w(), information_text(measured.information));
  }
  return text;
}

}  // namespace surefield
