#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "engine/report/plot.h"
#include "tools/report/report_sections.h"

namespace surefield {

/// The axes along which positions spread: most, less, least; where up is known, the third is that and the
/// others are level. World to axes.
struct PrincipalAxes {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< one a row
  bool upright = false;                                ///< the third is up

  Eigen::Vector3d of(const Eigen::Vector3d& position) const { return axes * (position - centre); }
};

PrincipalAxes principal_axes(const std::vector<Eigen::Vector3d>& positions,
                             const std::optional<Eigen::Vector3d>& up);

/// Where up is in the world of paths_of(), by the first run of the group whose map tells.
std::optional<Eigen::Vector3d> up_of(const std::vector<ReportRun>& runs, const RunGroup& group);

/// A line through space.
struct Path {
  std::string name;
  int colour = 0;
  std::vector<Eigen::Vector3d> positions;
};

/// The truth, if a run of the group knows it, and the runs' paths in its world.
std::vector<Path> paths_of(const std::vector<ReportRun>& runs, const RunGroup& group);

/// The paths along the first axis and another (1 or 2).
Plot map_plot(const std::string& title, const std::vector<Path>& paths, const PrincipalAxes& axes,
              int second);

}  // namespace surefield
