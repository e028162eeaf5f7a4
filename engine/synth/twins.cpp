// The twins: two rooms that look alike, one of them with two things more, joined by a corridor.
#include "engine/synth/furniture.h"
#include "engine/synth/places.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

constexpr double kHeight = 2.6, kDoor = 2.1;
constexpr double kTableTop = 0.767;        // a table on a rug
const Vector3d kSecond(5.4, 0, 0);         // from a thing in the first room to its twin
constexpr uint32_t kTwinTexture = 100000;  // number of the first texture that two bodies share

RoomPlan shell(const Palette& p, const Vector3d& low, const Vector3d& high) {
  RoomPlan plan;
  plan.low = low;
  plan.high = high + Vector3d(0, 0, kHeight);
  plan.floor = p.parquet;
  plan.ceiling = p.white_paint;
  plan.skirting = p.white_paint;
  for (int& wall : plan.walls) wall = p.plaster;
  return plan;
}

void first_room(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  RoomPlan plan = shell(p, {0, 0, 0}, {4.6, 4.2, 0});
  plan.walls[0] = p.accent;
  plan.walls[2] = p.wallpaper;
  plan.walls[3] = p.brick;
  plan.openings[1] = {{2.4, 3.8, 0.95, 2.2}};
  plan.openings[2] = {{0.9, 1.8, 0, kDoor}};
  build_room(b, plan);
  f.ceiling_lamp({2.3, 2.1, kHeight}, {1.5f, 1.35f, 1.1f}, 7);
  f.doorway({{1.35, -0.1, 0}, 0}, 0.9, kDoor);
  f.window({{4.6, 3.1, 0.95}, -90}, 1.4, 1.25);
  f.radiator({{4.6, 3.1, 0}, -90}, 1.2);
  f.rug({{2.6, 2.2, 0}, 0}, 2.6, 2.1);
  f.dining_table({{2.6, 2.3, 0.012}, 0}, 1.3);
  f.chair({{2.6, 1.5, 0.012}, 180 + b.random.uniform(-15, 15)});
  f.chair({{3.6, 2.3, 0.012}, -90 + b.random.uniform(-8, 8)});
  f.bowl({{2.6, 2.3, kTableTop}, 0});
  f.papers({{2.1, 2.35, kTableTop}, b.random.uniform(-20, 20)});
  f.sofa({{2.2, 3.77, 0}, 0}, 1.7);
  f.shelf({{4.45, 1.1, 0}, -90}, 0.9, 5);
  f.cabinet({{0.25, 2.4, 0}, 90}, 1.2, 0.85);
  f.laptop({{0.25, 2.4, 0.85}, 90 + b.random.uniform(-15, 15)});
  f.plant({{0.55, 3.65, 0}, b.random.uniform(0, 360)}, 1.1);
  f.floor_lamp({{4.2, 3.9, 0}, 0});
  f.boxes({{3.3, 0.4, 0}, 0}, 2);
  f.poster({{0, 1.2, 1.5}, 90}, 0.6, 0.8);
  f.poster({{0, 3.3, 1.55}, 90}, 0.8, 0.6);
  f.poster({{3.6, 4.2, 1.6}, 0}, 0.7, 0.9);
  f.poster({{2.7, 0, 1.5}, 180}, 0.9, 0.6);
  f.clock({{1.3, 4.2, 1.9}, 0});
}

/// Gives every body so far a twin, of the same texture to the pixel, and so the lamps.
void repeat(Scene& scene) {
  const std::size_t bodies = scene.shapes.size(), objects = scene.objects.size(),
                    lights = scene.lights.size();
  for (std::size_t i = 0; i < bodies; ++i) {
    scene.shapes[i].texture = kTwinTexture + static_cast<uint32_t>(i);
    Shape twin = scene.shapes[i];
    twin.shape_to_world.pretranslate(kSecond);
    twin.texture_origin += kSecond;
    twin.object += static_cast<int>(objects);
    scene.shapes.push_back(twin);
  }
  for (std::size_t i = 0; i < objects; ++i) scene.objects.push_back(std::string(scene.objects[i]));
  for (std::size_t i = 0; i < lights; ++i) {
    Light twin = scene.lights[i];
    twin.position += kSecond;
    scene.lights.push_back(twin);
  }
}

void way_between(SceneBuilder& b, Furniture& f) {
  const Palette& p = f.palette();
  RoomPlan plan = shell(p, {0, -2.2, 0}, {10, -0.2, 0});
  plan.floor = p.tiles;
  plan.openings[3] = {{0.9, 1.8, 0, kDoor}, {0.9 + kSecond.x(), 1.8 + kSecond.x(), 0, kDoor}};
  build_room(b, plan);
  const Eigen::Vector3f cool(1.2f, 1.25f, 1.25f);
  for (const double x : {1.35, 4.05, 1.35 + kSecond.x()}) f.ceiling_lamp({x, -1.2, kHeight}, cool, 5);
  f.bench({{3.9, -1.95, 0}, 180}, 1.4);
  f.plant({{9.4, -1.6, 0}, b.random.uniform(0, 360)}, 1.1);
  f.boxes({{0.4, -1.8, 0}, 0}, 3);
  f.poster({{3.2, -0.2, 1.5}, 0}, 0.9, 0.7);
  f.poster({{4.8, -0.2, 1.5}, 0}, 0.6, 0.8);
  f.whiteboard({{6.4, -2.2, 1.45}, 180});
  f.poster({{1.6, -2.2, 1.5}, 180}, 0.8, 0.6);
  f.poster({{10, -1.2, 1.5}, -90}, 0.7, 0.9);
}

/// What the first room does not have.
void difference(SceneBuilder& b, Furniture& f) {
  f.vase({kSecond + Vector3d(3.05, 2.15, kTableTop), 0});
  f.books({kSecond + Vector3d(2.95, 2.5, kTableTop), b.random.uniform(0, 90)});
}

/// Round the table of the first room, along the corridor, round that of the second in the same way, and back.
void circuit(Scene& scene) {
  const double z = 1.45;
  const auto stop = [&](double x, double y, const Vector3d& look, const Vector3d& off) {
    scene.circuit.push_back({off + Vector3d(x, y, z), off + look});
  };
  const auto room = [&](const Vector3d& off) {
    stop(1.35, 0.0, {2.4, 2.6, 0.8}, off);
    stop(1.35, 0.9, {2.8, 3.0, 0.7}, off);
    stop(1.25, 1.9, {2.8, 3.6, 0.8}, off);
    stop(1.5, 2.8, {3.4, 3.6, 0.8}, off);
    stop(2.3, 3.0, {4.3, 2.6, 0.8}, off);
    stop(3.2, 2.8, {4.4, 1.2, 0.8}, off);
    stop(3.6, 2.0, {3.4, 0.5, 0.7}, off);
    stop(3.1, 1.2, {1.2, 0.6, 0.8}, off);
    stop(2.3, 1.0, {0.4, 1.2, 0.8}, off);
    stop(1.5, 0.8, {0.9, -1.0, 0.9}, off);
    stop(1.35, 0.0, {1.7, -2.0, 0.9}, off);
  };
  stop(1.35, -1.0, {1.5, 1.5, 0.9}, Vector3d::Zero());
  room(Vector3d::Zero());
  stop(1.6, -1.0, {3.6, -1.6, 0.9}, Vector3d::Zero());
  stop(3.2, -1.0, {5.6, -1.5, 0.9}, Vector3d::Zero());
  stop(4.8, -1.0, {6.9, -0.8, 0.9}, Vector3d::Zero());
  stop(6.4, -1.0, {7.0, 1.2, 0.9}, Vector3d::Zero());
  room(kSecond);
  stop(6.5, -1.2, {4.0, -1.6, 0.9}, Vector3d::Zero());
  stop(4.8, -1.15, {2.6, -1.2, 0.9}, Vector3d::Zero());
  stop(3.2, -1.15, {1.0, -0.6, 0.9}, Vector3d::Zero());
  stop(2.0, -1.1, {0.8, 0.6, 0.9}, Vector3d::Zero());
  scene.first_stop = 0;  // in the corridor
}

}  // namespace

Scene make_twins(uint32_t seed) {
  SceneBuilder b("twins", seed);
  Furniture f(b);
  first_room(b, f);
  repeat(b.scene);
  way_between(b, f);
  difference(b, f);
  f.visitor({{2.6, -1.75}, {5.4, -1.75}, {5.4, -1.8}, {2.6, -1.8}});
  circuit(b.scene);
  return std::move(b.scene);
}

}  // namespace surefield
