// The office: desks under the windows, shelves, a meeting table, a sofa, and one wall left blank.
#include <cmath>
#include <numbers>

#include "engine/synth/furniture.h"
#include "engine/synth/places.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

constexpr double kLength = 7.2, kWidth = 5.8, kHeight = 2.8;

void shell(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  RoomPlan plan;
  plan.low = Vector3d::Zero();
  plan.high = {kLength, kWidth, kHeight};
  plan.walls[0] = p.blank;
  plan.walls[1] = p.accent;
  plan.walls[2] = p.brick;
  plan.walls[3] = p.plaster;
  plan.floor = b.random.index(2) == 0 ? p.parquet : p.carpet;
  plan.ceiling = p.ceiling;
  plan.skirting = p.white_paint;
  plan.openings[1] = {{0.55, 1.45, 0, 2.05}};
  plan.openings[3] = {{1.0, 2.6, 0.95, 2.25}, {4.4, 6.0, 0.95, 2.25}};
  build_room(b, plan);
  f.door({{kLength, 1.0, 0}, -90}, 0.9, 2.05);
  for (const double x : {1.8, 5.2}) {
    f.window({{x, kWidth, 0.95}, 0}, 1.6, 1.3);
    f.radiator({{x, kWidth, 0}, 0}, 1.4);
  }
  const Eigen::Vector3f white(1.75f, 1.66f, 1.50f);
  f.ceiling_lamp({2.2, 2.7, kHeight}, white, 9);
  f.ceiling_lamp({5.0, 2.7, kHeight}, white, 9);
}

void desks(SceneBuilder& b, Furniture& f) {
  for (const double x : {1.0, 3.0, 5.0}) {
    const Spot desk{{x + b.random.uniform(-0.08, 0.08), 5.15, 0}, b.random.uniform(-2, 2)};
    f.desk(desk, 1.5);
    f.work_place(desk);
    f.swivel_chair({{desk.at.x() + b.random.uniform(-0.2, 0.2), 4.45 + b.random.uniform(-0.1, 0.1), 0},
                    180 + b.random.uniform(-50, 50)});
  }
  f.bin({{2.0, 5.3, 0}, 0});
}

void shelves(SceneBuilder& b, Furniture& f) {
  for (const double x : {0.65, 1.6}) f.shelf({{x, 0.15, 0}, 180}, 0.9, 5);
  f.shelf({{2.55, 0.15, 0}, 180}, 0.9, 3);
  f.vase({{2.4, 0.15, 1.15}, 0});
  f.whiteboard({{4.0, 0, 1.45}, 180});
  f.cabinet({{5.6, 0.25, 0}, 180}, 1.35, 0.85);
  f.laptop({{5.4, 0.25, 0.85}, 180 + b.random.uniform(-20, 20)});
  f.books({{5.9, 0.22, 0.85}, b.random.uniform(0, 90)});
  f.boxes({{3.35, 0.35, 0}, 0}, 2);
}

void meeting(SceneBuilder& b, Furniture& f) {
  const double y = 2.45 + b.random.uniform(-0.1, 0.1), x = 3.5 + b.random.uniform(-0.15, 0.15);
  const Vector3d middle(x, y, 0);
  f.rug({middle, 0}, 2.9, 2.3);
  const Vector3d floor = middle + Vector3d(0, 0, 0.012), top = floor + Vector3d(0, 0, 0.74);
  f.round_table({floor, 0}, 0.62);
  const double start = b.random.uniform(20, 60);
  for (int i = 0; i < 4; ++i) {
    const double turn = start + 90 * i + b.random.uniform(-9, 9), angle = turn * std::numbers::pi / 180;
    // A chair's back is on its +y side: it faces the table when turned with its place around it.
    f.chair({floor + 0.82 * Vector3d(std::cos(angle), std::sin(angle), 0), turn - 90});
  }
  f.bowl({top, 0});
  f.laptop({top + Vector3d(-0.30, 0.20, 0), b.random.uniform(20, 80)});
  f.mug({top + Vector3d(0.28, 0.32, 0), b.random.uniform(0, 360)});
  f.mug({top + Vector3d(0.10, -0.42, 0), b.random.uniform(0, 360)});
  f.papers({top + Vector3d(0.33, -0.10, 0), b.random.uniform(0, 90)});
}

void lounge(SceneBuilder& b, Furniture& f) {
  f.sofa({{6.72, 3.2, 0}, -90}, 1.9);
  f.floor_lamp({{6.9, 4.5, 0}, 0});
  f.poster({{kLength, 2.75, 1.65}, -90}, 0.6, 0.85);
  f.poster({{kLength, 3.65, 1.60}, -90}, 0.8, 0.6);
  f.poster({{kLength, 4.7, 1.55}, -90}, 0.5, 0.7);
  f.poster({{3.5, kWidth, 1.55}, 0}, 0.7, 0.9);
  f.clock({{kLength, 1.0, 2.35}, -90});
  f.plant({{6.72, 1.7, 0}, b.random.uniform(0, 360)}, 1.1);
  f.thicket({{6.6, 5.42, 0}, 0}, 1.1);
  f.plant({{4.5, 0.45, 0}, b.random.uniform(0, 360)}, 0.9);
  f.ball({{0.55, 0.95, 0}, 0}, 0.14);
}

/// Around the meeting table, looking across it, along the wall and outwards in turn; the blank wall, at low
/// x, is faced for about a fifth of the way.
void circuit(Scene& scene) {
  const Vector3d middle(3.5, 2.55, 0);
  const auto stop = [&](double degrees, const Vector3d& look) {
    const double angle = degrees * std::numbers::pi / 180;
    scene.circuit.push_back({middle + Vector3d(1.85 * std::cos(angle), 1.05 * std::sin(angle), 1.45), look});
  };
  stop(0, {3.2, 4.9, 0.8});
  stop(36, {1.8, 5.4, 0.9});
  stop(72, {1.0, 4.6, 0.8});
  stop(108, {1.0, 5.2, 0.7});
  stop(144, {0.0, 2.7, 0.6});
  stop(180, {1.4, 0.2, 0.8});
  stop(216, {3.3, 0.6, 0.7});
  stop(252, {5.6, 0.6, 0.8});
  stop(288, {6.9, 2.2, 0.7});
  stop(324, {5.8, 4.8, 0.7});
}

}  // namespace

Scene make_office(uint32_t seed) {
  SceneBuilder b("office", seed);
  Furniture f(b);
  shell(b, f);
  desks(b, f);
  shelves(b, f);
  meeting(b, f);
  lounge(b, f);
  f.visitor({{1.0, 0.9}, {4.0, 0.9}, {4.0, 1.0}, {1.0, 1.0}});
  circuit(b.scene);
  return std::move(b.scene);
}

}  // namespace surefield
