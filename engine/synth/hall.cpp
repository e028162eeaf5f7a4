// The hall: large, with little in it and large plain surfaces.
#include "engine/synth/furniture.h"
#include "engine/synth/places.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

constexpr double kLength = 15, kWidth = 11, kHeight = 4.5;

void shell(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  RoomPlan plan;
  plan.low = Vector3d::Zero();
  plan.high = {kLength, kWidth, kHeight};
  plan.walls[0] = p.blank;
  plan.walls[1] = p.plaster;
  plan.walls[2] = p.plaster;
  plan.walls[3] = p.accent;
  plan.floor = p.tiles;
  plan.ceiling = p.ceiling;
  plan.skirting = p.grey_plastic;
  plan.openings[1] = {{5.0, 6.2, 0, 2.3}};
  plan.openings[2] = {{2.5, 4.5, 0.9, 3.2}, {6.5, 8.5, 0.9, 3.2}, {10.5, 12.5, 0.9, 3.2}};
  build_room(b, plan);
  f.door({{kLength, 5.6, 0}, -90}, 1.2, 2.3);
  for (const double x : {3.5, 7.5, 11.5}) f.window({{x, 0, 0.9}, 180}, 2.0, 2.3);
  const Eigen::Vector3f bright(3.2f, 3.0f, 2.7f);
  for (const double x : {4.0, 11.0})
    for (const double y : {3.2, 7.8}) f.ceiling_lamp({x, y, kHeight}, bright, 13);
}

void things(SceneBuilder& b, Furniture& f) {
  for (const double x : {4.2, 7.5, 10.8})
    for (const double y : {2.6, 8.4}) f.pillar({{x, y, 0}, 0}, 0.22, kHeight);
  f.bench({{2.0, 9.6, 0}, 20}, 1.8);
  f.bench({{7.5, 5.5, 0}, b.random.uniform(0, 40)}, 1.8);
  f.bench({{13.0, 2.0, 0}, 70}, 1.6);
  f.thicket({{7.5, 10.4, 0}, 0}, 1.3);
  f.thicket({{9.2, 10.4, 0}, 0}, 1.3);
  f.plant({{1.0, 1.0, 0}, b.random.uniform(0, 360)}, 1.9);
  f.plant({{14.0, 9.9, 0}, b.random.uniform(0, 360)}, 1.9);
  f.sofa({{12.6, 10.4, 0}, 0}, 2.0);
  f.low_table({{12.6, 9.3, 0}, 0});
  f.bowl({{12.6, 9.3, 0.41}, 0});
  f.rug({{3.2, 5.6, 0}, 15}, 2.6, 1.8);
  f.round_table({{3.2, 5.6, 0.012}, 0}, 0.5);
  f.vase({{3.2, 5.6, 0.752}, 0});
  f.boxes({{14.4, 1.0, 0}, 10}, 3);
  f.boxes({{13.7, 0.6, 0}, 0}, 2);
  f.ball({{9.4, 4.0, 0}, 0}, 0.3);
  f.ball({{5.6, 7.2, 0}, 0}, 0.22);
  f.floor_lamp({{11.2, 10.5, 0}, 0});
  f.cabinet({{4.0, kWidth - 0.25, 0}, 0}, 1.8, 0.9);
  f.laptop({{4.3, kWidth - 0.28, 0.9}, b.random.uniform(-20, 20)});
  for (const double x : {2.0, 6.0, 9.8}) f.poster({{x, kWidth, 2.0}, 0}, 1.2, 1.6);
  for (const double y : {2.6, 8.6}) f.poster({{kLength, y, 2.0}, -90}, 1.4, 1.8);
  f.clock({{kLength, 5.6, 2.8}, -90});
}

void circuit(Scene& scene) {
  const double z = 1.5;
  const auto stop = [&](double x, double y, const Vector3d& look) {
    scene.circuit.push_back({{x, y, z}, look});
  };
  stop(2.2, 3.6, {4.4, 4.8, 0.8});
  stop(3.8, 4.0, {6.6, 5.4, 0.5});
  stop(5.6, 4.2, {8.0, 5.4, 0.6});
  stop(7.4, 4.0, {10.2, 3.4, 0.6});
  stop(9.2, 5.0, {12.0, 3.0, 0.7});
  stop(11.0, 4.6, {13.8, 2.0, 0.6});
  stop(12.6, 5.2, {14.4, 6.6, 1.0});
  stop(12.4, 6.8, {12.8, 9.6, 0.6});
  stop(10.8, 7.0, {9.4, 9.8, 0.7});
  stop(9.0, 7.0, {7.6, 9.8, 0.8});
  stop(7.2, 7.2, {4.8, 8.8, 0.7});
  stop(5.4, 6.4, {3.4, 6.6, 0.6});
  stop(3.8, 7.4, {1.6, 8.6, 0.6});
  stop(2.2, 6.8, {0.6, 5.2, 0.8});
  stop(1.8, 5.2, {3.0, 3.4, 0.8});
}

}  // namespace

Scene make_hall(uint32_t seed) {
  SceneBuilder b("hall", seed);
  Furniture f(b);
  shell(b, f);
  things(b, f);
  f.visitor({{5.6, 1.4}, {9.4, 1.4}, {9.4, 1.8}, {5.6, 1.8}});
  circuit(b.scene);
  return std::move(b.scene);
}

}  // namespace surefield
