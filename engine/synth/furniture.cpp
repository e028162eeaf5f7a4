// Large pieces of furniture.
#include "engine/synth/furniture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surefield {

using Eigen::Vector3d;

namespace {

Vector3d polar(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace

void Furniture::legs(double width, double depth, double height, double thickness, int material) {
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      b_.box({x * (width - thickness), y * (depth - thickness), 0}, {thickness, thickness, height}, material);
}

void Furniture::desk(const Spot& spot, double width) {
  b_.begin("desk", spot);
  const int wood = b_.random.index(3) == 0 ? p_.white_lacquer : p_.oak;
  b_.box({0, 0, 0.70}, {width, 0.7, 0.03}, wood);
  legs(width - 0.04, 0.66, 0.70, 0.05, p_.steel);
  b_.box({0, 0.31, 0.40}, {width - 0.14, 0.02, 0.30}, p_.grey_plastic);
  const double side = b_.random.index(2) == 0 ? -1 : 1;
  b_.box({side * (0.5 * width - 0.30), 0.02, 0}, {0.40, 0.55, 0.58}, p_.white_lacquer);
  for (const double z : {0.03, 0.215, 0.40}) {
    b_.box({side * (0.5 * width - 0.30), -0.262, z}, {0.37, 0.015, 0.165}, wood);
    b_.box({side * (0.5 * width - 0.30), -0.277, z + 0.07}, {0.12, 0.016, 0.016}, p_.steel);
  }
}

void Furniture::chair(const Spot& spot) {
  b_.begin("chair", spot);
  const int wood = b_.random.index(2) == 0 ? p_.oak : p_.walnut;
  legs(0.42, 0.42, 0.44, 0.04, wood);
  b_.box({0, 0, 0.44}, {0.45, 0.45, 0.035}, any(p_.fabrics));
  for (const double x : {-0.19, 0.19}) b_.box({x, 0.19, 0.475}, {0.035, 0.03, 0.42}, wood);
  for (const double z : {0.56, 0.68, 0.80}) b_.box({0, 0.19, z}, {0.35, 0.018, 0.07}, wood);
}

void Furniture::swivel_chair(const Spot& spot) {
  b_.begin("swivel chair", spot);
  const int fabric = any(p_.fabrics);
  for (int i = 0; i < 5; ++i) {
    const double angle = 2 * std::numbers::pi * i / 5 + 0.3;
    b_.rod({0, 0, 0.10}, polar(0.29, angle, 0.07), 0.016, p_.black_plastic);
    b_.ellipsoid(polar(0.29, angle, 0.03), {0.03, 0.03, 0.03}, p_.black_plastic);
  }
  b_.cylinder({0, 0, 0.08}, 0.028, 0.36, p_.steel);
  b_.box({0, 0, 0.44}, {0.48, 0.46, 0.07}, fabric);
  b_.box({0, 0.23, 0.46}, {0.07, 0.02, 0.22}, p_.black_plastic);
  b_.box({0, 0.21, 0.60}, {0.44, 0.05, 0.42}, fabric);
  for (const double x : {-0.26, 0.26}) {
    b_.box({x, 0.02, 0.47}, {0.03, 0.05, 0.18}, p_.black_plastic);
    b_.box({x, 0, 0.65}, {0.06, 0.26, 0.025}, p_.black_plastic);
  }
}

void Furniture::round_table(const Spot& spot, double radius) {
  b_.begin("round table", spot);
  b_.cylinder({0, 0, 0.71}, radius, 0.03, p_.walnut);
  b_.cylinder({0, 0, 0.02}, 0.05, 0.69, p_.steel);
  b_.cylinder({0, 0, 0}, 0.28, 0.02, p_.steel);
}

void Furniture::dining_table(const Spot& spot, double length) {
  b_.begin("table", spot);
  b_.box({0, 0, 0.72}, {length, 0.85, 0.035}, p_.oak);
  b_.box({0, 0, 0.64}, {length - 0.2, 0.65, 0.08}, p_.walnut);
  legs(length - 0.04, 0.81, 0.72, 0.06, p_.walnut);
}

void Furniture::low_table(const Spot& spot) {
  b_.begin("low table", spot);
  b_.box({0, 0, 0.38}, {0.9, 0.5, 0.03}, p_.walnut);
  b_.box({0, 0, 0.14}, {0.8, 0.4, 0.02}, p_.walnut);
  legs(0.86, 0.46, 0.38, 0.045, p_.walnut);
}

void Furniture::book_row(double left, double right, double z, double depth) {
  double x = left;
  while (true) {
    const double thickness = b_.random.uniform(0.022, 0.06), height = b_.random.uniform(0.19, 0.30);
    if (x + thickness > right) return;
    const double deep = std::min(b_.random.uniform(0.15, 0.22), depth);
    b_.box({x + 0.5 * thickness, 0.5 * depth - 0.5 * deep - 0.01, z}, {thickness - 0.002, deep, height},
           any(p_.books));
    x += thickness;
  }
}

void Furniture::shelf(const Spot& spot, double width, int boards) {
  b_.begin("shelf", spot);
  constexpr double kDepth = 0.30, kStep = 0.37, kBoard = 0.022;
  const double height = boards * kStep + 0.06;
  const int wood = b_.random.index(2) == 0 ? p_.walnut : p_.oak;
  for (const double side : {-0.5, 0.5})
    b_.box({side * (width - kBoard), 0, 0}, {kBoard, kDepth, height}, wood);
  b_.box({0, 0.5 * kDepth - 0.006, 0}, {width - 2 * kBoard, 0.012, height}, p_.white_lacquer);
  for (int i = 0; i <= boards; ++i)
    b_.box({0, -0.006, i * kStep + 0.04 - kBoard}, {width - 2 * kBoard, kDepth - 0.012, kBoard}, wood);
  const double inner = 0.5 * width - kBoard;
  for (int i = 0; i < boards; ++i) {
    const double z = i * kStep + 0.04, split = b_.random.uniform(-0.5, 0.9) * inner;
    book_row(-inner + 0.01, split, z, kDepth - 0.03);
    const double rest = inner - split;
    if (rest < 0.22) continue;
    const double middle = split + 0.5 * rest + 0.03;
    const int what = b_.random.index(3);
    if (what == 0) b_.box({middle, 0, z}, {0.6 * rest, 0.20, b_.random.uniform(0.14, 0.26)}, p_.cardboard);
    if (what == 1) b_.ellipsoid({middle, 0, z + 0.09}, {0.09, 0.09, 0.09}, any(p_.gaudy));
    if (what == 2) {
      const int glaze = any(p_.gaudy);
      b_.cylinder({middle, 0, z}, 0.06, b_.random.uniform(0.15, 0.25), glaze);
    }
  }
}

void Furniture::cabinet(const Spot& spot, double width, double height) {
  b_.begin("cabinet", spot);
  const int front = b_.random.index(2) == 0 ? p_.oak : p_.white_lacquer;
  b_.box({0, 0.01, 0.06}, {width, 0.43, height - 0.06}, p_.white_lacquer);
  b_.box({0, 0.03, 0}, {width - 0.06, 0.36, 0.06}, p_.black_plastic);
  const int doors = std::max(1, static_cast<int>(std::lround(width / 0.45)));
  for (int i = 0; i < doors; ++i) {
    const double x = (i + 0.5) * width / doors - 0.5 * width;
    b_.box({x, -0.213, 0.08}, {width / doors - 0.01, 0.016, height - 0.10}, front);
    b_.rod({x + 0.14, -0.235, 0.5 * height}, {x + 0.14, -0.235, 0.5 * height + 0.14}, 0.007, p_.steel);
    for (const double z : {0.01, 0.13})
      b_.rod({x + 0.14, -0.235, 0.5 * height + z}, {x + 0.14, -0.218, 0.5 * height + z}, 0.005, p_.steel);
  }
}

void Furniture::sofa(const Spot& spot, double width) {
  b_.begin("sofa", spot);
  const int fabric = any(p_.fabrics);
  b_.box({0, 0, 0.10}, {width, 0.82, 0.20}, fabric);
  legs(width - 0.1, 0.72, 0.10, 0.06, p_.walnut);
  b_.box({0, 0.32, 0.30}, {width, 0.18, 0.50}, fabric);
  for (const double side : {-0.5, 0.5})
    b_.box({side * (width - 0.16), -0.09, 0.30}, {0.16, 0.64, 0.28}, fabric);
  const int seats = width > 1.7 ? 3 : 2;
  const double seat = (width - 0.34) / seats;
  for (int i = 0; i < seats; ++i)
    b_.box({(i + 0.5 - 0.5 * seats) * seat, -0.09, 0.30}, {seat - 0.012, 0.62, 0.13}, fabric);
  for (const double side : {-0.30, 0.28})
    b_.ellipsoid({side * width, 0.13, 0.60}, {0.20, 0.09, 0.18}, p_.cushion);
}

void Furniture::bed(const Spot& spot) {
  b_.begin("bed", spot);
  b_.box({0, 0, 0.12}, {1.45, 2.05, 0.16}, p_.oak);
  legs(1.4, 2.0, 0.12, 0.08, p_.oak);
  b_.box({0, 0, 0.28}, {1.40, 2.00, 0.18}, p_.cloth);
  b_.box({0, -0.28, 0.46}, {1.44, 1.40, 0.05}, any(p_.fabrics));
  b_.box({0, 1.00, 0.28}, {1.45, 0.05, 0.62}, p_.oak);
  for (const double x : {-0.36, 0.36}) b_.ellipsoid({x, 0.70, 0.52}, {0.30, 0.20, 0.085}, p_.cushion);
}

void Furniture::kitchen_row(const Spot& spot, double width) {
  b_.begin("kitchen", spot);
  const int count = std::max(2, static_cast<int>(std::lround(width / 0.6)));
  const double unit = width / count;
  b_.box({0, 0.02, 0.08}, {width, 0.54, 0.80}, p_.white_lacquer);
  b_.box({0, 0.05, 0}, {width, 0.44, 0.08}, p_.black_plastic);
  b_.box({0, 0, 0.88}, {width, 0.60, 0.04}, p_.walnut);
  for (int i = 0; i < count; ++i) {
    const double x = (i + 0.5) * unit - 0.5 * width;
    b_.box({x, -0.258, 0.10}, {unit - 0.012, 0.016, 0.76}, i == 1 ? p_.steel : p_.white_paint);
    b_.rod({x - 0.12, -0.28, 0.80}, {x + 0.12, -0.28, 0.80}, 0.008, p_.steel);
    b_.box({x, 0.12, 1.45}, {unit - 0.012, 0.36, 0.62}, i % 2 == 0 ? p_.white_paint : p_.oak);
  }
  b_.box({-0.5 * width + 1.5 * unit, 0, 0.92}, {0.50, 0.46, 0.008}, p_.black_plastic);
  b_.box({0, 0.297, 0.92}, {width, 0.006, 0.53}, p_.tiles);
}

void Furniture::floor_lamp(const Spot& spot) {
  b_.begin("floor lamp", spot);
  b_.cylinder({0, 0, 0}, 0.15, 0.025, p_.steel);
  b_.cylinder({0, 0, 0.025}, 0.012, 1.42, p_.steel);
  b_.cylinder({0, 0, 1.40}, 0.19, 0.26, p_.lamp);
  b_.no_shadow();
  b_.scene.lights.push_back({b_.on_top({0, 0, 1.52}, 0).at, {0.9f, 0.65f, 0.40f}, 4});
}

void Furniture::boxes(const Spot& spot, int count) {
  double z = 0, size = b_.random.uniform(0.40, 0.52);
  for (int i = 0; i < count; ++i) {
    b_.begin("box", {spot.at + Vector3d(0, 0, z), spot.turn + b_.random.uniform(-12, 12)});
    const double height = b_.random.uniform(0.22, 0.36);
    b_.box({0, 0, 0}, {size, 0.8 * size, height}, p_.cardboard);
    b_.box({0, 0, height}, {0.05, 0.8 * size - 0.002, 0.001}, p_.leather);
    b_.box({0.2 * size, -0.4 * size - 0.001, 0.4 * height}, {0.12, 0.002, 0.08}, p_.white_paint);
    z += height + 0.001;
    size *= 0.85;
  }
}

void Furniture::bin(const Spot& spot) {
  b_.begin("bin", spot);
  b_.cylinder({0, 0, 0}, 0.13, 0.30, any(p_.gaudy));
  b_.cylinder({0, 0, 0.30}, 0.12, 0.004, p_.black_plastic);
}

void Furniture::rug(const Spot& spot, double length, double width) {
  b_.begin("rug", spot);
  b_.box({0, 0, 0}, {length, width, 0.012}, p_.rug);
}

void Furniture::ball(const Spot& spot, double radius) {
  b_.begin("ball", spot);
  b_.ellipsoid({0, 0, radius}, {radius, radius, radius}, any(p_.gaudy));
}

void Furniture::pillar(const Spot& spot, double radius, double height) {
  b_.begin("pillar", spot);
  b_.box({0, 0, 0}, {2.5 * radius, 2.5 * radius, 0.14}, p_.tiles);
  b_.cylinder({0, 0, 0.14}, radius, height - 0.28, p_.plaster);
  b_.box({0, 0, height - 0.14}, {2.5 * radius, 2.5 * radius, 0.14}, p_.plaster);
}

void Furniture::bench(const Spot& spot, double length) {
  b_.begin("bench", spot);
  for (int i = 0; i < 4; ++i) b_.box({0, -0.17 + 0.115 * i, 0.42}, {length, 0.09, 0.035}, p_.oak);
  for (const double side : {-0.38, 0.38}) b_.box({side * length, 0, 0}, {0.06, 0.40, 0.42}, p_.steel);
}

void Furniture::foliage(const Vector3d& crown, double radius, int count, double leaf_length) {
  for (int i = 0; i < count; ++i) {
    const double turn = b_.random.uniform(0, 2 * std::numbers::pi), height = b_.random.uniform(-0.7, 1);
    const double out = radius * b_.random.uniform(0.35, 1) * std::sqrt(1 - 0.8 * height * height);
    const Vector3d tip = crown + polar(out, turn, 0.8 * radius * height);
    const Vector3d along = (tip - crown + Vector3d(0, 0, b_.random.uniform(-0.3, 0.1) * radius)).normalized();
    b_.rod(crown - Vector3d(0, 0, 0.3 * radius), tip - 0.8 * leaf_length * along, 0.004, p_.bark);
    b_.leaf(tip, {leaf_length, 0.38 * leaf_length, 0.003}, along, Vector3d(0.2, 0.1, 1),
            b_.random.index(2) == 0 ? p_.leaf : p_.dark_leaf);
  }
}

void Furniture::plant(const Spot& spot, double height) {
  b_.begin("plant", spot);
  const double pot = 0.13 + 0.03 * height;
  b_.cylinder({0, 0, 0}, pot, 0.28, p_.terracotta);
  b_.cylinder({0, 0, 0.28}, 0.9 * pot, 0.006, p_.soil);
  b_.rod({0, 0, 0.28}, {0.02, 0.01, 0.62 * height}, 0.014, p_.bark);
  foliage({0.02, 0.01, 0.72 * height}, 0.30 * height, 34, 0.10 * height);
}

void Furniture::thicket(const Spot& spot, double height) {
  b_.begin("thicket", spot);
  b_.box({0, 0, 0}, {0.70, 0.30, 0.32}, p_.white_lacquer);
  b_.box({0, 0, 0.32}, {0.64, 0.24, 0.006}, p_.soil);
  for (int i = 0; i < 36; ++i) {
    const double root_y = b_.random.uniform(-0.10, 0.10), root_x = b_.random.uniform(-0.30, 0.30);
    const double rise = height * b_.random.uniform(0.5, 0.8);
    const double lean_y = b_.random.uniform(-0.12, 0.06), lean_x = b_.random.uniform(-0.10, 0.10);
    const Vector3d root(root_x, root_y, 0.32), lean(lean_x, lean_y, rise);
    b_.rod(root, root + lean, b_.random.uniform(0.003, 0.006), p_.bark);
    const Vector3d at = root + b_.random.uniform(0.55, 1) * lean;
    const double up = b_.random.uniform(-0.2, 0.8);
    const Vector3d along = polar(1, b_.random.uniform(0, 2 * std::numbers::pi), up).normalized();
    b_.leaf(at + 0.07 * along, {0.075, 0.018, 0.002}, along, Vector3d(0.1, 0.2, 1), p_.leaf);
  }
}

}  // namespace surefield
