#include "engine/viewer/legend.h"

#include <doctest/doctest.h>

#include <set>

#include "engine/viewer/axes_gizmo.h"
#include "engine/viewer/backdrop.h"

using namespace surefield;

TEST_CASE("modes that paint values have a legend with ends, unit and ticks; the others have none") {
  const std::set<ViewMode> scaled = {ViewMode::Depth,       ViewMode::MedianDepth,         ViewMode::Opacity,
                                     ViewMode::Uncertainty, ViewMode::GaussianUncertainty, ViewMode::Error};
  for (const ViewModeInfo& info : view_modes()) {
    const std::string name = info.name;
    CAPTURE(name);
    const auto legend = legend_of({.mode = info.mode});
    CHECK(legend.has_value() == (scaled.count(info.mode) == 1));
    if (!legend) continue;
    CHECK(legend->palette.size() == kPaletteSize);
    CHECK(legend->palette.front() != legend->palette.back());
    CHECK(legend->low < legend->high);
    CHECK(legend->ticks.size() == legend->text.size());
    CHECK(legend->ticks.size() >= 3);
  }
}

TEST_CASE("scales of less than a metre are in centimetres, the others in metres, shares in neither") {
  const auto depth = legend_of({.mode = ViewMode::Depth, .depth_near = 1, .depth_far = 4});
  CHECK(depth->title == "depth, m");
  CHECK(depth->low == doctest::Approx(1));
  CHECK(depth->high == doctest::Approx(4));
  CHECK(depth->text.front() == "1");
  CHECK(depth->text.back() == "4");
  const auto sigma = legend_of({.mode = ViewMode::GaussianUncertainty, .error_far = 0.2f});
  CHECK(sigma->title == "uncertainty (1 sigma), cm");
  CHECK(sigma->high == doctest::Approx(20));
  CHECK(sigma->text.back() == "20");
  const auto opacity = legend_of({.mode = ViewMode::Opacity});
  CHECK(opacity->title == "opacity");
  CHECK(opacity->high == doctest::Approx(1));
  CHECK(opacity->text[1] == "0.2");
}

TEST_CASE("the axes are where the camera sees them, the ones that point to the viewer last") {
  // Looks along the world's y: x to the right, z up.
  Pose camera_to_world = Pose::Identity();
  camera_to_world.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const auto arms = axes_seen(camera_to_world, -Eigen::Vector3d::UnitY());
  CHECK(std::string(arms.back().name) == "up");
  CHECK(arms.back().towards == doctest::Approx(1));
  CHECK(arms.back().tip.norm() < 1e-12);
  CHECK(std::string(arms.front().name) == "y");
  for (const AxisArm& arm : arms) {
    if (std::string(arm.name) == "x") CHECK((arm.tip - Eigen::Vector2d(1, 0)).norm() < 1e-12);
    if (std::string(arm.name) == "z") CHECK((arm.tip - Eigen::Vector2d(0, -1)).norm() < 1e-12);
  }
}

TEST_CASE("backdrops follow each other in a circle, and the first is what pictures have without a choice") {
  Backdrop backdrop = Backdrop::Squares;
  ViewSettings settings;
  std::set<std::pair<uint32_t, float>> looks;
  for (std::size_t i = 0; i < backdrops().size(); ++i) {
    set_backdrop(settings, backdrop);
    looks.insert({settings.checker, settings.background.x()});
    backdrop = next_backdrop(backdrop);
  }
  CHECK(looks.size() == backdrops().size());
  CHECK(backdrop == Backdrop::Squares);
  set_backdrop(settings, backdrop);
  CHECK(settings == ViewSettings{});
}
