// The time that a frame may take, within which mapping steps are left out.
#include <doctest/doctest.h>

#include "tests/slam/office.h"

using namespace surefield;
using namespace surefield::testing;

TEST_CASE("a budget cuts mapping steps of keyframes and no frame; one that is not reached changes no bit") {
  const auto feed = [](Slam& slam) {
    for (int i = 0; i < 7; ++i) slam.feed(office_frames()[static_cast<std::size_t>(i)]);
  };
  SlamSettings settings = quick_settings();
  Slam free(settings, office_camera(), engine_options());
  feed(free);
  settings.budget_ms = 1e6;
  Slam ample(settings, office_camera(), engine_options());
  feed(ample);
  CHECK(same_results(free, ample));
  settings.budget_ms = 1e-3;
  Slam tight(settings, office_camera(), engine_options());
  feed(tight);
  const std::vector<FrameReport> reports = tight.reports();
  REQUIRE(reports.size() == 7);
  CHECK(reports[0].mapping_iterations == settings.first_iterations);
  CHECK(reports[3].mapping_iterations == 2);
  CHECK(reports[6].mapping_iterations == 2);
  CHECK(reports[5].mapping_iterations == 0);
}

TEST_CASE("the end of a run is not cut by the budget of its last frame") {
  SlamSettings settings = quick_settings();
  settings.budget_ms = 1e-3;
  Slam slam(settings, office_camera(), engine_options());
  for (int i = 0; i < 2; ++i) slam.feed(office_frames()[static_cast<std::size_t>(i)]);
  slam.finish();
  CHECK(slam.reports().back().mapping_iterations == settings.mapping_iterations);
}
