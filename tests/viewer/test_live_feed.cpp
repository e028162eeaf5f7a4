#include <doctest/doctest.h>

#include <future>
#include <thread>

#include "engine/viewer/live_feed.h"

using namespace surefield;
using namespace std::chrono_literals;

namespace {

/// Publishes a frame; counts how often the scene and the map were asked for.
struct Run {
  LiveFeed& feed;
  int scenes = 0;
  int maps = 0;
  int frames = 0;

  void publish(bool keyframe) {
    ++frames;
    feed.publish(
        {.loss = static_cast<float>(frames)}, keyframe,
        [&] {
          ++scenes;
          ViewerScene scene;
          scene.status = std::to_string(frames);
          return scene;
        },
        [&] {
          ++maps;
          GaussianCloud map;
          map.resize(static_cast<std::size_t>(frames));
          return map;
        });
  }
};

}  // namespace

TEST_CASE("a run hands over every number, but a scene and a map only when the window has asked") {
  LiveFeed feed;
  Run run{feed};
  run.publish(true);
  run.publish(true);
  run.publish(false);
  CHECK(run.scenes == 1);
  CHECK(run.maps == 1);
  const LiveFeed::Update first = feed.take();
  CHECK(first.numbers.size() == 3);
  REQUIRE(first.scene);
  CHECK(first.scene->status == "1");
  REQUIRE(first.map);
  CHECK(first.map->size() == 1);
  CHECK_FALSE(first.finished);

  run.publish(false);
  run.publish(true);
  CHECK(run.scenes == 2);
  CHECK(run.maps == 2);  // at the keyframe
  const LiveFeed::Update second = feed.take();
  CHECK(second.numbers.size() == 2);
  CHECK(second.numbers[0].loss == 4);
  CHECK(second.scene->status == "4");
  CHECK(second.map->size() == 5);
  const LiveFeed::Update nothing = feed.take();
  CHECK_FALSE(nothing.scene);
  CHECK_FALSE(nothing.map);
  CHECK(nothing.numbers.empty());
  feed.finish({}, {});
  CHECK(feed.take().finished);
}

TEST_CASE("what is announced before the first frame is shown until that is done, which it does not delay") {
  LiveFeed feed;
  ViewerScene scene;
  scene.waiting_for = "the first frame";
  feed.announce(scene);
  CHECK(feed.take().scene->waiting_for == "the first frame");
  feed.announce(scene);
  Run run{feed};
  run.publish(true);
  const LiveFeed::Update update = feed.take();
  CHECK(update.scene->status == "1");
  CHECK(update.scene->waiting_for.empty());
  CHECK(update.map);
}

TEST_CASE("a paused run waits, takes single steps, and goes on when it is asked to or to end") {
  LiveFeed feed;
  CHECK(feed.may_go_on(0ms));
  feed.pause(true);
  CHECK_FALSE(feed.may_go_on(1ms));
  feed.step();
  CHECK(feed.may_go_on(0ms));
  CHECK_FALSE(feed.may_go_on(1ms));
  auto waiting = std::async(std::launch::async, [&] { return feed.may_go_on(60s); });
  feed.pause(false);
  CHECK(waiting.get());
  feed.pause(true);
  CHECK_FALSE(feed.stop_wanted());
  feed.stop();
  CHECK(feed.may_go_on(0ms));
  CHECK(feed.stop_wanted());
}

TEST_CASE("changes of settings arrive once, in order") {
  LiveFeed feed;
  feed.change("a", 1);
  feed.change("b", 0.5);
  feed.change("a", 2);
  const auto changes = feed.take_changes();
  REQUIRE(changes.size() == 3);
  CHECK(changes[2] == std::pair<std::string, double>("a", 2));
  CHECK(feed.take_changes().empty());
}
