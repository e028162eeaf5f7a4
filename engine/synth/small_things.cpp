// Things that stand on furniture, hang on walls or fill openings.
#include <cmath>
#include <numbers>

#include "engine/synth/furniture.h"

namespace surefield {

using Eigen::Vector3d;

void Furniture::work_place(const Spot& desk) {
  constexpr double kTop = 0.73;
  const Eigen::Isometry3d frame = Eigen::Translation3d(desk.at) *
                                  Eigen::AngleAxisd(desk.turn * std::numbers::pi / 180, Vector3d::UnitZ());
  const auto spot = [&](double x, double y, double turn) {
    return Spot{frame * Vector3d(x, y, kTop), desk.turn + turn};
  };
  const double monitor_turn = b_.random.uniform(-8, 8);
  b_.begin("monitor", spot(b_.random.uniform(-0.1, 0.1), 0.17, monitor_turn));
  b_.box({0, 0, 0}, {0.22, 0.16, 0.012}, p_.black_plastic);
  b_.box({0, 0.04, 0.012}, {0.05, 0.03, 0.28}, p_.black_plastic);
  b_.box({0, 0.005, 0.12}, {0.56, 0.03, 0.34}, p_.black_plastic);
  b_.box({0, -0.012, 0.13}, {0.53, 0.004, 0.31}, p_.screen);
  b_.begin("keyboard", spot(0, -0.16, b_.random.uniform(-5, 5)));
  b_.box({0, 0, 0}, {0.43, 0.14, 0.015}, p_.grey_plastic);
  for (int row = 0; row < 4; ++row)
    b_.box({0, -0.048 + 0.032 * row, 0.015}, {0.41, 0.026, 0.007}, p_.black_plastic);
  b_.begin("mouse", spot(0.32, -0.17, 0));
  b_.ellipsoid({0, 0, 0.018}, {0.03, 0.05, 0.018}, p_.black_plastic);
  mug(spot(-0.34, -0.10, b_.random.uniform(0, 360)));
  papers(spot(0.46, 0.06, b_.random.uniform(-30, 30)));
  if (b_.random.index(2) == 0) {
    books(spot(-0.48, 0.12, b_.random.uniform(-20, 20)));
  } else {
    desk_lamp(spot(-0.52, 0.18, b_.random.uniform(20, 60)));
  }
}

void Furniture::books(const Spot& top) {
  b_.begin("books", top);
  double z = 0;
  const int count = 2 + b_.random.index(4);
  for (int i = 0; i < count; ++i) {
    const double thickness = b_.random.uniform(0.018, 0.045);
    const double turn = b_.random.uniform(-18, 18);
    const int cover = any(p_.books);
    b_.box({0, 0, z}, {b_.random.uniform(0.15, 0.20), b_.random.uniform(0.20, 0.26), thickness}, cover, turn);
    z += thickness;
  }
}

void Furniture::mug(const Spot& top) {
  b_.begin("mug", top);
  const int glaze = any(p_.gaudy);
  b_.cylinder({0, 0, 0}, 0.04, 0.095, glaze);
  b_.cylinder({0, 0, 0.095}, 0.034, 0.001, p_.soil);
  b_.rod({0.035, 0, 0.075}, {0.065, 0, 0.07}, 0.006, glaze);
  b_.rod({0.065, 0, 0.072}, {0.062, 0, 0.028}, 0.006, glaze);
  b_.rod({0.064, 0, 0.03}, {0.035, 0, 0.022}, 0.006, glaze);
}

void Furniture::bowl(const Spot& top) {
  b_.begin("bowl", top);
  b_.cylinder({0, 0, 0}, 0.13, 0.035, p_.ceramic);
  for (int i = 0; i < 5; ++i) {
    const double turn = 2 * std::numbers::pi * i / 5;
    b_.ellipsoid({0.065 * std::cos(turn), 0.065 * std::sin(turn), 0.07}, {0.037, 0.037, 0.035},
                 any(p_.gaudy));
  }
}

void Furniture::laptop(const Spot& top) {
  b_.begin("laptop", top);
  b_.box({0, 0, 0}, {0.33, 0.23, 0.016}, p_.steel);
  b_.box({0, 0.02, 0.016}, {0.29, 0.11, 0.002}, p_.black_plastic);
  b_.box({0, 0.12, 0.01}, {0.33, 0.012, 0.22}, p_.steel);
  b_.box({0, 0.113, 0.02}, {0.31, 0.004, 0.20}, p_.screen);
}

void Furniture::papers(const Spot& top) {
  b_.begin("papers", top);
  for (int i = 0; i < 3; ++i) {
    const double turn = b_.random.uniform(-14, 14);
    b_.box({b_.random.uniform(-0.02, 0.02), b_.random.uniform(-0.02, 0.02), 0.002 * i}, {0.21, 0.297, 0.002},
           i == 2 ? p_.posters[4] : p_.white_paint, turn);
  }
}

void Furniture::desk_lamp(const Spot& top) {
  b_.begin("desk lamp", top);
  const int metal = any(p_.gaudy);
  b_.cylinder({0, 0, 0}, 0.075, 0.018, metal);
  b_.rod({0, 0, 0.01}, {0, 0.09, 0.24}, 0.008, p_.steel);
  b_.rod({0, 0.09, 0.24}, {0, -0.09, 0.38}, 0.008, p_.steel);
  b_.rod({0, -0.06, 0.39}, {0, -0.15, 0.33}, 0.045, metal);
}

void Furniture::vase(const Spot& top) {
  b_.begin("vase", top);
  b_.ellipsoid({0, 0, 0.09}, {0.07, 0.07, 0.09}, p_.ceramic);
  b_.cylinder({0, 0, 0.13}, 0.03, 0.09, p_.ceramic);
  for (int i = 0; i < 7; ++i) {
    const double turn = 0.9 * i;
    const Vector3d head(0.09 * std::cos(turn), 0.09 * std::sin(turn), 0.36 + 0.02 * (i % 3));
    b_.rod({0, 0, 0.2}, head, 0.003, p_.leaf);
    b_.ellipsoid(head, {0.024, 0.024, 0.018}, any(p_.gaudy));
  }
}

void Furniture::poster(const Spot& on_wall, double width, double height) {
  b_.begin("poster", on_wall);
  b_.box({0, -0.006, -0.5 * height}, {width, 0.012, height}, any(p_.posters));
}

void Furniture::whiteboard(const Spot& on_wall) {
  b_.begin("whiteboard", on_wall);
  b_.box({0, -0.008, -0.5}, {1.5, 0.016, 1.0}, p_.white_paint);
  for (const double z : {-0.52, 0.5}) b_.box({0, -0.012, z}, {1.54, 0.024, 0.02}, p_.steel);
  for (const double x : {-0.76, 0.76}) b_.box({x, -0.012, -0.5}, {0.02, 0.024, 1.0}, p_.steel);
  b_.box({0, -0.04, -0.54}, {0.5, 0.08, 0.015}, p_.steel);
  b_.box({-0.4, -0.0175, -0.2}, {0.45, 0.003, 0.5}, p_.posters[4]);
  for (int i = 0; i < 4; ++i)
    b_.box({0.15 + 0.14 * i, -0.018, -0.1 + 0.12 * (i % 2)}, {0.08, 0.004, 0.08}, any(p_.gaudy), 0);
}

void Furniture::clock(const Spot& on_wall) {
  b_.begin("clock", on_wall);
  b_.rod({0, 0, 0}, {0, -0.04, 0}, 0.15, p_.black_plastic);
  b_.rod({0, -0.04, 0}, {0, -0.042, 0}, 0.135, p_.white_paint);
  b_.box({0, -0.044, 0}, {0.012, 0.003, 0.11}, p_.black_plastic);
  b_.rod({0, -0.045, 0}, {0.07, -0.045, 0.02}, 0.005, p_.black_plastic);
}

void Furniture::radiator(const Spot& on_wall, double width) {
  b_.begin("radiator", on_wall);
  const int fins = static_cast<int>(width / 0.07);
  for (int i = 0; i < fins; ++i)
    b_.box({(i + 0.5 - 0.5 * fins) * 0.07, -0.07, 0.14}, {0.045, 0.08, 0.52}, p_.white_paint);
  for (const double z : {0.18, 0.58}) b_.box({0, -0.045, z}, {width, 0.09, 0.03}, p_.white_paint);
}

void Furniture::ceiling_lamp(const Vector3d& at, const Eigen::Vector3f& colour, double range) {
  b_.begin("ceiling lamp", {at, 0});
  b_.box({0, 0, -0.05}, {1.2, 0.24, 0.05}, p_.steel);
  b_.no_shadow();
  b_.box({0, 0, -0.06}, {1.16, 0.20, 0.01}, p_.lamp);
  b_.no_shadow();
  b_.scene.lights.push_back({at - Vector3d(0, 0, 0.12), colour, range});
}

void Furniture::door(const Spot& in_wall, double width, double height) {
  b_.begin("door", in_wall);
  const double t = kWallThickness;
  b_.box({0, 0.5 * t, 0}, {width - 0.12, 0.04, height - 0.06}, p_.oak);
  for (const double side : {-0.5, 0.5})
    b_.box({side * (width - 0.06), 0.5 * t - 0.012, 0}, {0.06, t, height}, p_.white_paint);
  b_.box({0, 0.5 * t - 0.012, height - 0.06}, {width - 0.12, t, 0.06}, p_.white_paint);
  for (const double z : {0.25, 1.15}) b_.box({0, 0.5 * t - 0.025, z}, {width - 0.36, 0.012, 0.7}, p_.walnut);
  b_.rod({0.36 * width, 0.5 * t - 0.06, 1.02}, {0.36 * width, 0.5 * t, 1.02}, 0.012, p_.brass);
  b_.rod({0.36 * width, 0.5 * t - 0.06, 1.02}, {0.24 * width, 0.5 * t - 0.06, 1.02}, 0.01, p_.brass);
}

void Furniture::door_leaf(const Spot& on_wall, double width, double height) {
  b_.begin("door", on_wall);
  b_.box({0, -0.015, 0}, {width - 0.12, 0.03, height - 0.06}, p_.oak);
  for (const double side : {-0.5, 0.5})
    b_.box({side * (width - 0.06), -0.025, 0}, {0.06, 0.05, height}, p_.white_paint);
  b_.box({0, -0.025, height - 0.06}, {width - 0.12, 0.05, 0.06}, p_.white_paint);
  for (const double z : {0.25, 1.15}) b_.box({0, -0.036, z}, {width - 0.36, 0.012, 0.7}, p_.walnut);
  b_.rod({0.36 * width, -0.08, 1.02}, {0.36 * width, -0.03, 1.02}, 0.012, p_.brass);
  b_.rod({0.36 * width, -0.08, 1.02}, {0.24 * width, -0.08, 1.02}, 0.01, p_.brass);
}

void Furniture::doorway(const Spot& between, double width, double height) {
  b_.begin("doorway", between);
  constexpr double kBoard = 0.02, kDepth = 2 * kWallThickness + 0.04;
  for (const double side : {-0.5, 0.5})
    b_.box({side * (width - kBoard), 0, 0}, {kBoard, kDepth, height}, p_.white_paint);
  b_.box({0, 0, height - kBoard}, {width - 2 * kBoard, kDepth, kBoard}, p_.white_paint);
}

void Furniture::visitor(const std::vector<Eigen::Vector2d>& track) {
  const std::size_t first = b_.scene.shapes.size();
  b_.begin("visitor");
  const int shirt = any(p_.gaudy), trousers = any(p_.fabrics);
  for (const double side : {-0.1, 0.1}) {
    b_.cylinder({0.02, side, 0.08}, 0.075, 0.76, trousers);
    b_.ellipsoid({0.06, side, 0.045}, {0.14, 0.055, 0.045}, p_.black_plastic);
    b_.rod({0, 2.3 * side, 1.42}, {0.12, 2.6 * side, 0.98}, 0.045, shirt);
    b_.ellipsoid({0.14, 2.6 * side, 0.93}, {0.05, 0.04, 0.07}, p_.cushion);
  }
  b_.ellipsoid({0, 0, 1.18}, {0.13, 0.21, 0.38}, shirt);
  b_.cylinder({0, 0, 1.48}, 0.055, 0.1, p_.cushion);
  b_.ellipsoid({0.01, 0, 1.68}, {0.10, 0.08, 0.13}, p_.cushion);
  b_.ellipsoid({-0.02, 0, 1.73}, {0.105, 0.09, 0.11}, p_.bark);
  MovingObject& who = b_.scene.visitor;
  who.shapes.assign(b_.scene.shapes.begin() + static_cast<std::ptrdiff_t>(first), b_.scene.shapes.end());
  b_.scene.shapes.resize(first);
  who.track = track;
}

void Furniture::window(const Spot& in_wall, double width, double height) {
  b_.begin("window", in_wall);
  const double t = kWallThickness, bar = 0.05;
  b_.box({0, t - 0.01, 0}, {width, 0.02, height}, p_.view);
  for (const double x : {-0.5 * (width - bar), 0.0, 0.5 * (width - bar)})
    b_.box({x, t - 0.04, 0}, {bar, 0.04, height}, p_.white_paint);
  for (const double z : {0.0, 0.62 * height, height - bar})
    b_.box({0, t - 0.038, z}, {width - bar, 0.036, bar}, p_.white_paint);
  b_.box({0, 0.5 * t, -0.026}, {width, 0.9 * t, 0.03}, p_.white_paint);
  b_.box({0, -0.05, -0.026}, {width + 0.1, 0.1, 0.031}, p_.white_paint);
}

}  // namespace surefield
