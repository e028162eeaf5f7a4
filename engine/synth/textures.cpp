#include "engine/synth/textures.h"

#include <cmath>

namespace surefield {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

int cell(float x) {
  return static_cast<int>(std::floor(x));
}

float fade(float x) {
  return x * x * (3 - 2 * x);
}

/// Value noise: lattice values blended smoothly, 0 to 1, features of about one unit.
float smooth_noise(const Vector2f& p, uint32_t seed) {
  const int x = cell(p.x()), y = cell(p.y());
  const float fx = fade(p.x() - static_cast<float>(x)), fy = fade(p.y() - static_cast<float>(y));
  const float near = std::lerp(lattice_noise(x, y, seed), lattice_noise(x + 1, y, seed), fx);
  const float far = std::lerp(lattice_noise(x, y + 1, seed), lattice_noise(x + 1, y + 1, seed), fx);
  return std::lerp(near, far, fy);
}

/// Three octaves of value noise, 0 to 1.
float layered_noise(const Vector2f& p, uint32_t seed) {
  return (4 * smooth_noise(p, seed) + 2 * smooth_noise(2.1f * p, seed + 1) +
          smooth_noise(4.3f * p, seed + 2)) /
         7;
}

float wood(const Vector2f& p, uint32_t seed) {
  const int board = cell(p.y());
  const float joint = p.y() - static_cast<float>(board) < 0.06f ? 0.f : 1.f;
  const float grain = layered_noise({0.7f * p.x(), 9 * p.y()}, seed + static_cast<uint32_t>(board));
  return joint * (0.35f * lattice_noise(board, 0, seed) + 0.65f * grain);
}

float bricks(const Vector2f& p, uint32_t seed) {
  const int row = cell(2 * p.y());
  const float x = p.x() + 0.5f * static_cast<float>(row & 1);
  const float to_joint_x = x - std::floor(x), to_joint_y = 2 * p.y() - static_cast<float>(row);
  if (to_joint_x < 0.06f || to_joint_y < 0.12f) return 0;
  return 0.6f + 0.4f * lattice_noise(cell(x), row, seed);
}

/// Squares of random colour with a ring in each, tinted by the material's two colours.
Vector3f poster(const Material& material, const Vector2f& p) {
  const int x = cell(p.x()), y = cell(p.y());
  const Vector3f patch(lattice_noise(x, y, material.seed), lattice_noise(x, y, material.seed + 1),
                       lattice_noise(x, y, material.seed + 2));
  const float from_middle = (p - Vector2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f)).norm();
  const bool ring = from_middle > 0.22f && from_middle < 0.42f;
  return 0.5f * patch + 0.5f * (ring ? material.first : material.second);
}

/// How much of the material's second colour shows, 0 to 1.
float blend(const Material& material, const Vector2f& p) {
  switch (material.pattern) {
    case Pattern::Checks:
      return ((cell(2 * p.x()) + cell(2 * p.y())) & 1) != 0 ? 1.f : 0.f;
    case Pattern::Stripes:
      return fade(p.x() - std::floor(p.x()));
    case Pattern::Wood:
      return wood(p, material.seed);
    case Pattern::Bricks:
      return bricks(p, material.seed);
    default:
      return layered_noise(p, material.seed);
  }
}

}  // namespace

float lattice_noise(int x, int y, uint32_t seed) {
  // Integer mixing only, so that the scene is the same on every machine.
  uint32_t h =
      static_cast<uint32_t>(x) * 0x8da6b343u ^ static_cast<uint32_t>(y) * 0xd8163841u ^ seed * 0xcb1ab31fu;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  h ^= h >> 16;
  return static_cast<float>(h >> 8) * 0x1p-24f;
}

Vector3f texture(const Material& material, const Vector2f& uv) {
  const Vector2f p = uv / material.scale;
  const Vector3f base =
      material.pattern == Pattern::Poster
          ? poster(material, p)
          : Vector3f(material.first + blend(material, p) * (material.second - material.first));
  // Grain of a fixed physical size (about 20 cm, 10 cm and 5 cm features).
  return base * (0.75f + 0.45f * layered_noise(5 * uv, material.seed + 77));
}

}  // namespace surefield
