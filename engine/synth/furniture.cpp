// What stands in the synthetic room, and what it is made of.

#include <cmath>
#include <numbers>

#include "engine/synth/room.h"

namespace surefield {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

const Material kOak{Pattern::Wood, {0.38f, 0.22f, 0.10f}, {0.80f, 0.56f, 0.32f}, 0.18f, 11};
const Material kWalnut{Pattern::Wood, {0.20f, 0.11f, 0.07f}, {0.55f, 0.34f, 0.21f}, 0.12f, 12};
const Material kBlueCloth{Pattern::Checks, {0.15f, 0.25f, 0.45f}, {0.30f, 0.45f, 0.70f}, 0.16f, 13};
const Material kRedStripes{Pattern::Stripes, {0.80f, 0.22f, 0.16f}, {0.95f, 0.85f, 0.70f}, 0.10f, 14};
const Material kCrate{Pattern::Bricks, {0.25f, 0.20f, 0.12f}, {0.75f, 0.62f, 0.35f}, 0.24f, 15};
const Material kGreenPaint{Pattern::Plaster, {0.12f, 0.40f, 0.22f}, {0.45f, 0.75f, 0.40f}, 0.10f, 16};
const Material kRug{Pattern::Checks, {0.55f, 0.15f, 0.18f}, {0.85f, 0.70f, 0.45f}, 0.40f, 17};

}  // namespace

SyntheticRoom::SyntheticRoom(uint32_t seed)
    : seed_(seed),
      walls_{{Pattern::Bricks, {0.80f, 0.76f, 0.70f}, {0.66f, 0.34f, 0.25f}, 0.50f, seed},
             {Pattern::Plaster, {0.62f, 0.68f, 0.55f}, {0.90f, 0.92f, 0.78f}, 0.30f, seed + 1},
             {Pattern::Stripes, {0.55f, 0.62f, 0.75f}, {0.86f, 0.88f, 0.93f}, 0.35f, seed + 2},
             {Pattern::Plaster, {0.80f, 0.66f, 0.45f}, {0.97f, 0.88f, 0.72f}, 0.35f, seed + 3},
             {Pattern::Wood, {0.36f, 0.24f, 0.15f}, {0.72f, 0.54f, 0.36f}, 0.22f, seed + 4},
             {Pattern::Checks, {0.74f, 0.74f, 0.72f}, {0.92f, 0.92f, 0.90f}, 1.20f, seed + 5}} {
  add_table();
  add_furniture();
  add_posters();
}

void SyntheticRoom::add_box(const Vector3d& lowest_centre, const Vector3d& box_size, double yaw_degrees,
                            Material material) {
  material.seed += seed_;
  const double yaw = yaw_degrees * std::numbers::pi / 180;
  const Vector3d centre = lowest_centre + Vector3d(0, 0, 0.5 * box_size.z());
  boxes_.push_back({centre, 0.5 * box_size, std::cos(yaw), std::sin(yaw), material});
}

void SyntheticRoom::add_table() {
  const Vector3d middle(2.5, 2.0, 0);
  add_box(middle, {2.2, 1.6, 0.01}, 0, kRug);
  add_box(middle + Vector3d(0, 0, 0.70), {1.2, 0.7, 0.04}, 12, kOak);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(12 * std::numbers::pi / 180, Vector3d::UnitZ()).matrix();
  for (const double x : {-0.52, 0.52}) {
    for (const double y : {-0.28, 0.28}) {
      add_box(middle + turn * Vector3d(x, y, 0), {0.06, 0.06, 0.70}, 12, kWalnut);
    }
  }
  add_box({2.20, 1.95, 0.74}, {0.26, 0.18, 0.20}, 35, kRedStripes);
  add_box({2.75, 2.20, 0.74}, {0.30, 0.22, 0.05}, -20, kBlueCloth);
  add_box({2.75, 2.20, 0.79}, {0.26, 0.19, 0.04}, 5, kRedStripes);
  spheres_.push_back(
      {{2.62, 1.88, 0.86}, 0.12, {Pattern::Checks, {0.9f, 0.8f, 0.2f}, {0.2f, 0.2f, 0.5f}, 0.12f, 18}});
}

void SyntheticRoom::add_furniture() {
  // A bookcase on the low-y wall: sides, boards and a few rows of books.
  for (const double x : {0.9, 2.3}) add_box({x, 0.18, 0}, {0.04, 0.32, 1.9}, 0, kWalnut);
  for (const double z : {0.05, 0.65, 1.25, 1.86}) add_box({1.6, 0.18, z}, {1.4, 0.32, 0.04}, 0, kWalnut);
  add_box({1.30, 0.16, 0.69}, {0.60, 0.22, 0.36}, 0,
          {Pattern::Stripes, {0.2f, 0.3f, 0.2f}, {0.9f, 0.8f, 0.5f}, 0.07f, 21});
  add_box({1.95, 0.16, 1.29}, {0.50, 0.22, 0.40}, 0,
          {Pattern::Stripes, {0.6f, 0.1f, 0.1f}, {0.3f, 0.5f, 0.9f}, 0.09f, 22});
  add_box({1.50, 0.16, 0.09}, {1.00, 0.24, 0.42}, 0,
          {Pattern::Stripes, {0.1f, 0.1f, 0.3f}, {0.8f, 0.8f, 0.8f}, 0.06f, 23});
  // A sofa on the high-x wall.
  add_box({4.55, 2.0, 0}, {0.80, 1.90, 0.42}, 0, kBlueCloth);
  add_box({4.85, 2.0, 0.42}, {0.20, 1.90, 0.45}, 0, kBlueCloth);
  add_box({4.50, 1.15, 0.42}, {0.70, 0.18, 0.22}, 0, kBlueCloth);
  add_box({4.50, 2.85, 0.42}, {0.70, 0.18, 0.22}, 0, kBlueCloth);
  add_box({4.62, 2.45, 0.42}, {0.16, 0.42, 0.38}, 15, kRedStripes);
  // A cabinet with a ball on the high-y wall, crates in a corner, a plant pot in another.
  add_box({2.6, 3.75, 0}, {1.30, 0.45, 0.85}, 0, kOak);
  spheres_.push_back({{2.9, 3.72, 1.05}, 0.20, kGreenPaint});
  add_box({2.25, 3.72, 0.85}, {0.35, 0.25, 0.45}, 10, kCrate);
  add_box({0.55, 3.40, 0}, {0.60, 0.60, 0.60}, 25, kCrate);
  add_box({0.50, 3.45, 0.60}, {0.40, 0.40, 0.40}, -10, kCrate);
  add_box({0.40, 0.95, 0}, {0.35, 0.35, 0.40}, 40, kRedStripes);
  spheres_.push_back({{0.40, 0.95, 0.70}, 0.33, kGreenPaint});
}

void SyntheticRoom::add_posters() {
  const auto poster = [&](const Vector3d& lowest_centre, const Vector3d& box_size, const Vector3f& tint,
                          uint32_t n) {
    add_box(lowest_centre, box_size, 0, {Pattern::Poster, tint, 0.5f * tint, 0.14f, 30 + n});
  };
  poster({0.01, 1.7, 1.15}, {0.02, 0.80, 1.00}, {0.9f, 0.7f, 0.3f}, 0);
  poster({0.01, 2.7, 1.35}, {0.02, 0.60, 0.60}, {0.3f, 0.7f, 0.9f}, 1);
  poster({4.99, 1.3, 1.20}, {0.02, 0.90, 0.70}, {0.9f, 0.4f, 0.4f}, 2);
  poster({4.99, 2.9, 1.10}, {0.02, 0.70, 1.00}, {0.4f, 0.9f, 0.5f}, 3);
  poster({1.3, 3.99, 1.20}, {1.00, 0.02, 0.80}, {0.6f, 0.5f, 0.9f}, 4);
  poster({3.9, 3.99, 1.10}, {0.70, 0.02, 0.95}, {0.9f, 0.9f, 0.4f}, 5);
  poster({3.4, 0.01, 1.10}, {1.10, 0.02, 0.85}, {0.4f, 0.8f, 0.9f}, 6);
}

}  // namespace surefield
