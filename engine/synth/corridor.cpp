// The corridor: a closed way around a block, with doors, benches and plants along it.
#include "engine/synth/furniture.h"
#include "engine/synth/places.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

constexpr double kLength = 12, kWidth = 9, kHeight = 2.6, kAisle = 1.9;

void outside(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  RoomPlan plan;
  plan.low = Vector3d::Zero();
  plan.high = {kLength, kWidth, kHeight};
  plan.walls[0] = p.plaster;
  plan.walls[1] = p.accent;
  plan.walls[2] = p.plaster;
  plan.walls[3] = p.blank;
  plan.floor = p.tiles;
  plan.ceiling = p.ceiling;
  plan.skirting = p.grey_plastic;
  plan.openings[2] = {{2, 3.6, 0.95, 2.2}, {5.2, 6.8, 0.95, 2.2}, {8.4, 10, 0.95, 2.2}};
  plan.openings[3] = {{5.5, 6.4, 0, 2.05}};
  build_room(b, plan);
  for (const double x : {2.8, 6.0, 9.2}) {
    f.window({{x, 0, 0.95}, 180}, 1.6, 1.25);
    f.radiator({{x, 0, 0}, 180}, 1.3);
  }
  f.door({{5.95, kWidth, 0}, 0}, 0.9, 2.05);
}

/// The block in the middle, one wall of its own on each side.
void block(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  const double x0 = kAisle, x1 = kLength - kAisle, y0 = kAisle, y1 = kWidth - kAisle, t = kWallThickness;
  b.begin("room");
  b.wall({x0, y0, 0}, {x1, y0 + t, kHeight}, p.wallpaper);
  b.wall({x0, y1 - t, 0}, {x1, y1, kHeight}, p.plaster);
  b.wall({x0, y0 + t, 0}, {x0 + t, y1 - t, kHeight}, p.brick);
  b.wall({x1 - t, y0 + t, 0}, {x1, y1 - t, kHeight}, p.plaster);
  for (const double x : {3.6, 6.4, 8.9}) f.door_leaf({{x, y0, 0}, 0}, 0.9, 2.05);
  for (const double x : {4.4, 8.2}) f.door_leaf({{x, y1, 0}, 180}, 0.9, 2.05);
  for (const double y : {3.2, 5.6}) f.door_leaf({{x1, y, 0}, 90}, 0.9, 2.05);
  for (const double x : {2.6, 5.0, 7.6}) f.poster({{x, y0, 1.5}, 0}, 0.6, 0.85);
  f.clock({{x0, 4.5, 2.0}, -90});
  f.poster({{x0, 3.2, 1.5}, -90}, 0.9, 0.7);
  f.whiteboard({{6.3, y1, 1.45}, 180});
  f.poster({{x1, 4.4, 1.5}, 90}, 0.7, 0.9);
  f.poster({{2.8, y1, 1.5}, 180}, 0.6, 0.8);
}

void things(SceneBuilder& b, Furniture& f) {
  f.bench({{4.4, 0.3, 0}, 180}, 1.1);
  f.bench({{0.3, 6.3, 0}, 90}, 1.4);
  f.bench({{8.0, kWidth - 0.3, 0}, 0}, 1.4);
  f.plant({{7.6, 0.48, 0}, b.random.uniform(0, 360)}, 1.0);
  f.plant({{0.5, 8.5, 0}, b.random.uniform(0, 360)}, 1.1);
  f.plant({{11.5, 0.5, 0}, b.random.uniform(0, 360)}, 1.1);
  f.thicket({{0.6, 0.37, 0}, 180}, 1.0);
  f.thicket({{11.35, 8.62, 0}, 0}, 1.1);
  f.cabinet({{11.75, 5.6, 0}, -90}, 1.3, 1.0);
  f.vase({{11.75, 5.4, 1.0}, 0});
  f.books({{11.75, 5.9, 1.0}, b.random.uniform(0, 90)});
  f.shelf({{11.85, 2.9, 0}, -90}, 0.9, 4);
  f.boxes({{3.2, 8.65, 0}, 0}, 3);
  f.boxes({{10.2, 8.6, 0}, 0}, 2);
  f.bin({{0.25, 5.0, 0}, 0});
  f.bin({{7.3, 8.8, 0}, 0});
  f.ball({{1.4, 8.7, 0}, 0}, 0.13);
  f.poster({{0, 3.6, 1.5}, 90}, 0.8, 0.6);
  f.poster({{0, 7.4, 1.5}, 90}, 0.6, 0.9);
  f.poster({{kLength, 7.2, 1.55}, -90}, 0.7, 0.9);
  const Eigen::Vector3f cool(1.2f, 1.25f, 1.25f);
  for (const double x : {2.4, 6.0, 9.6}) {
    f.ceiling_lamp({x, 0.95, kHeight}, cool, 6);
    f.ceiling_lamp({x, kWidth - 0.95, kHeight}, cool, 6);
  }
  for (const double x : {0.95, kLength - 0.95}) f.ceiling_lamp({x, 4.5, kHeight}, cool, 6);
}

/// Along the middle of the aisles, looking ahead and to the sides in turn.
void circuit(Scene& scene) {
  const double a = 1.0, z = 1.45;
  const auto stop = [&](double x, double y, const Vector3d& off) {
    scene.circuit.push_back({{x, y, z}, Vector3d(x, y, 0.9) + off});
  };
  for (const double x : {2.0, 3.5, 5.0, 6.5, 8.0, 9.5})
    stop(x, a, {2.2, x == 5.0 || x == 8.0 ? -0.6 : 0.5, 0});
  stop(kLength - a - 0.15, a + 0.15, {1.6, 2.2, 0});
  for (const double y : {2.5, 4.0, 5.5, 7.0}) stop(kLength - a, y, {y == 4.0 ? -0.7 : 0.5, 2.2, 0});
  stop(kLength - a - 0.15, kWidth - a - 0.15, {-2.2, 1.2, 0});
  for (const double x : {9.5, 8.0, 6.5, 5.0, 3.5, 2.0})
    stop(x, kWidth - a, {-2.2, x == 8.0 || x == 3.5 ? 0.7 : -0.6, 0});
  stop(a + 0.15, kWidth - a - 0.15, {-1.2, -2.2, 0});
  for (const double y : {7.0, 5.5, 4.0, 2.5}) stop(a, y, {y == 5.5 ? 0.7 : -0.5, -2.2, 0});
  stop(a + 0.15, a + 0.15, {2.2, -0.8, 0});
}

}  // namespace

Scene make_corridor(uint32_t seed) {
  SceneBuilder b("corridor", seed);
  Furniture f(b);
  outside(b, f);
  block(b, f);
  things(b, f);
  f.visitor({{3.0, 0.7}, {9.0, 0.7}, {9.0, 1.5}, {3.0, 1.5}});
  circuit(b.scene);
  return std::move(b.scene);
}

}  // namespace surefield
