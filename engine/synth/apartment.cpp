// The apartment: living room, kitchen, study and bedroom around a closed walk through four doorways.
#include "engine/synth/furniture.h"
#include "engine/synth/places.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

constexpr double kHeight = 2.6, kDoor = 2.1;
const Eigen::Vector3f kWarm(1.5f, 1.35f, 1.1f);

RoomPlan room(const Palette& p, const Vector3d& low, const Vector3d& high, int floor) {
  RoomPlan plan;
  plan.low = low;
  plan.high = high + Vector3d(0, 0, kHeight);
  plan.floor = floor;
  plan.ceiling = p.white_paint;
  plan.skirting = p.white_paint;
  for (int& wall : plan.walls) wall = p.plaster;
  return plan;
}

void living_room(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  RoomPlan plan = room(p, {0, 0, 0}, {5, 4.6, 0}, p.parquet);
  plan.walls[0] = p.blank;
  plan.walls[2] = p.wallpaper;
  plan.openings[1] = {{1.9, 2.8, 0, kDoor}};
  plan.openings[2] = {{1.7, 3.3, 0.9, 2.2}};
  plan.openings[3] = {{1.6, 2.5, 0, kDoor}};
  build_room(b, plan);
  f.ceiling_lamp({2.4, 2.4, kHeight}, kWarm, 8);
  f.window({{2.5, 0, 0.9}, 180}, 1.6, 1.3);
  f.radiator({{2.5, 0, 0}, 180}, 1.3);
  f.rug({{2.0, 2.3, 0}, 0}, 2.2, 1.6);
  f.sofa({{0.46, 2.3, 0}, 90}, 2.1);
  f.low_table({{1.75, 2.3, 0.012}, 90});
  f.bowl({{1.75, 2.3, 0.422}, 0});
  f.books({{1.75, 2.62, 0.422}, b.random.uniform(0, 90)});
  f.floor_lamp({{0.4, 3.75, 0}, 0});
  f.cabinet({{4.25, 0.25, 0}, 180}, 1.2, 0.55);
  f.laptop({{4.25, 0.25, 0.55}, 180});
  f.shelf({{4.0, 4.45, 0}, 0}, 1.0, 4);
  f.plant({{0.75, 0.75, 0}, b.random.uniform(0, 360)}, 1.4);
  f.poster({{0, 2.3, 1.6}, 90}, 0.9, 0.6);
  f.poster({{5, 3.6, 1.5}, -90}, 0.6, 0.8);
  f.clock({{5, 1.2, 1.9}, -90});
  f.ball({{3.0, 4.2, 0}, 0}, 0.12);
}

void kitchen(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  RoomPlan plan = room(p, {5.2, 0, 0}, {8.4, 4.6, 0}, p.tiles);
  plan.walls[1] = p.brick;
  plan.openings[0] = {{1.9, 2.8, 0, kDoor}};
  plan.openings[1] = {{2.4, 3.8, 1.0, 2.2}};
  plan.openings[3] = {{6.1, 7.0, 0, kDoor}};
  build_room(b, plan);
  f.ceiling_lamp({6.6, 2.3, kHeight}, kWarm, 7);
  f.kitchen_row({{6.8, 0.30, 0}, 180}, 3.0);
  f.mug({{6.2, 0.30, 0.92}, b.random.uniform(0, 360)});
  f.bowl({{7.9, 0.30, 0.92}, 0});
  f.window({{8.4, 3.1, 1.0}, -90}, 1.4, 1.2);
  f.radiator({{8.4, 3.1, 0}, -90}, 1.2);
  f.dining_table({{7.75, 2.6, 0}, 90}, 1.3);
  f.vase({{7.75, 2.6, 0.755}, 0});
  f.papers({{7.7, 2.95, 0.755}, b.random.uniform(0, 90)});
  f.chair({{7.12, 2.3, 0}, 90 + b.random.uniform(-15, 15)});
  f.chair({{7.12, 2.95, 0}, 90 + b.random.uniform(-15, 15)});
  f.chair({{7.75, 3.55, 0}, b.random.uniform(-15, 15)});
  f.bin({{5.4, 4.35, 0}, 0});
  f.poster({{5.2, 3.7, 1.5}, 90}, 0.5, 0.7);
}

void study(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  RoomPlan plan = room(p, {4.4, 4.8, 0}, {8.4, 8.4, 0}, p.carpet);
  plan.walls[3] = p.accent;
  plan.openings[0] = {{6.2, 7.1, 0, kDoor}};
  plan.openings[1] = {{5.3, 6.2, 0, 2.05}};
  plan.openings[2] = {{6.1, 7.0, 0, kDoor}};
  plan.openings[3] = {{5.6, 7.2, 0.95, 2.2}};
  build_room(b, plan);
  f.ceiling_lamp({6.4, 6.6, kHeight}, kWarm, 7);
  f.door({{8.4, 5.75, 0}, -90}, 0.9, 2.05);
  f.window({{6.4, 8.4, 0.95}, 0}, 1.6, 1.25);
  const Spot desk{{6.4, 7.95, 0}, b.random.uniform(-2, 2)};
  f.desk(desk, 1.5);
  f.work_place(desk);
  f.swivel_chair({{6.4, 7.3, 0}, 180 + b.random.uniform(-40, 40)});
  f.shelf({{8.25, 7.2, 0}, -90}, 0.9, 5);
  f.shelf({{4.9, 4.95, 0}, 180}, 0.9, 5);
  f.boxes({{7.95, 8.1, 0}, 0}, 2);
  f.boxes({{4.75, 8.05, 0}, 0}, 3);
  f.poster({{4.4, 5.6, 1.5}, 90}, 0.6, 0.8);
  f.thicket({{7.8, 5.15, 0}, 180}, 1.1);
}

void bedroom(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  RoomPlan plan = room(p, {0, 4.8, 0}, {4.2, 8.4, 0}, p.parquet);
  plan.walls[3] = p.wallpaper;
  plan.openings[0] = {{5.9, 7.3, 0.9, 2.2}};
  plan.openings[1] = {{6.2, 7.1, 0, kDoor}};
  plan.openings[2] = {{1.6, 2.5, 0, kDoor}};
  build_room(b, plan);
  f.ceiling_lamp({2.1, 6.4, kHeight}, kWarm, 7);
  f.window({{0, 6.6, 0.9}, 90}, 1.4, 1.3);
  f.bed({{1.2, 7.36, 0}, 0});
  f.cabinet({{2.25, 8.15, 0}, 0}, 0.45, 0.5);
  f.desk_lamp({{2.25, 8.15, 0.5}, 30});
  f.cabinet({{3.5, 8.15, 0}, 0}, 1.35, 2.0);
  f.cabinet({{3.6, 5.05, 0}, 180}, 1.1, 0.8);
  f.books({{3.4, 5.05, 0.8}, b.random.uniform(0, 90)});
  f.vase({{3.85, 5.05, 0.8}, 0});
  f.poster({{1.2, 8.4, 1.65}, 0}, 1.0, 0.6);
  f.plant({{0.6, 5.5, 0}, b.random.uniform(0, 360)}, 1.1);
  f.chair({{0.9, 5.05, 0}, 180});
}

void circuit(Scene& scene) {
  const double z = 1.45;
  const auto stop = [&](double x, double y, const Vector3d& look) {
    scene.circuit.push_back({{x, y, z}, look});
  };
  stop(2.05, 4.0, {2.0, 1.8, 0.6});
  stop(1.9, 3.0, {1.5, 0.6, 0.8});
  stop(2.4, 1.7, {3.2, 0.3, 0.9});
  stop(3.4, 1.8, {4.6, 0.6, 0.7});
  stop(4.3, 2.35, {6.6, 1.4, 0.8});
  stop(5.1, 2.35, {7.4, 1.6, 0.8});
  stop(5.9, 2.3, {7.8, 2.8, 0.8});
  stop(6.4, 3.0, {7.6, 4.4, 0.8});
  stop(6.55, 3.9, {6.4, 6.6, 0.8});
  stop(6.55, 4.7, {6.2, 7.2, 0.8});
  stop(6.5, 5.5, {7.6, 7.6, 0.8});
  stop(6.2, 6.3, {6.2, 8.2, 0.7});
  stop(5.2, 6.65, {3.2, 7.6, 0.9});
  stop(4.3, 6.65, {2.2, 7.4, 0.8});
  stop(3.4, 6.6, {1.4, 7.6, 0.6});
  stop(2.5, 6.2, {0.4, 6.2, 0.8});
  stop(2.05, 5.5, {1.9, 3.4, 0.6});
  stop(2.05, 4.7, {1.8, 2.4, 0.6});
}

}  // namespace

Scene make_apartment(uint32_t seed) {
  SceneBuilder b("apartment", seed);
  Furniture f(b);
  living_room(b, f);
  kitchen(b, f);
  study(b, f);
  bedroom(b, f);
  f.doorway({{5.1, 2.35, 0}, 90}, 0.9, kDoor);
  f.doorway({{6.55, 4.7, 0}, 0}, 0.9, kDoor);
  f.doorway({{4.3, 6.65, 0}, 90}, 0.9, kDoor);
  f.doorway({{2.05, 4.7, 0}, 0}, 0.9, kDoor);
  f.visitor({{2.6, 3.3}, {4.0, 3.3}, {4.0, 3.4}, {2.6, 3.4}});
  circuit(b.scene);
  return std::move(b.scene);
}

}  // namespace surefield
