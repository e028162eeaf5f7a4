#include "engine/synth/palette.h"

#include <array>

namespace surefield {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

Material plain(uint32_t colour, float gloss = 0.04f) {
  Material m;
  m.first = m.second = linear_colour(colour);
  m.gloss = gloss;
  return m;
}

/// Two colours that noise blends; `frequency` in features per metre along each axis of the body.
Material noisy(uint32_t first, uint32_t second, const Vector3f& frequency, float contrast) {
  Material m = plain(first);
  m.second = linear_colour(second);
  m.noise_frequency = frequency;
  m.noise_contrast = contrast;
  return m;
}

Material wood(uint32_t first, uint32_t second) {
  Material m = noisy(first, second, {1.5f, 14, 14}, 0.9f);
  m.noise_decay = 0.8f;
  m.gloss = 0.12f;
  m.shininess = 40;
  return m;
}

Material celled(Material m, const Vector2f& cell, float shift, float contrast, float joint) {
  m.cell = cell;
  m.cell_shift = shift;
  m.cell_contrast = contrast;
  m.joint = joint;
  return m;
}

Material picture(Pattern pattern, uint32_t first, uint32_t second, float emission) {
  Material m = plain(first, 0.05f);
  m.second = linear_colour(second);
  m.pattern = pattern;
  m.emission = emission;
  return m;
}

Material cloth_of(uint32_t first, uint32_t second, float thread) {
  Material m = celled(noisy(first, second, {9, 9, 9}, 0.5f), {thread, thread}, 0.5f, 0.7f, 0.15f * thread);
  m.gloss = 0;
  return m;
}

}  // namespace

Palette::Palette(SceneBuilder& b) {
  RandomStream& random = b.random;
  const auto pick = [&](const auto& choices) {
    return choices[random.index(static_cast<int>(choices.size()))];
  };
  const std::array<uint32_t, 4> wall_paints = {0xe6dccb, 0xd5dee0, 0xdfe2d2, 0xe9e1d8};
  const std::array<uint32_t, 4> accents = {0x5f8294, 0x9a5f4b, 0x6f8a63, 0xb08a4a};
  const uint32_t paint = pick(wall_paints);

  blank = b.material(plain(paint, 0));
  plaster = b.material(noisy(paint, 0xb9a98f, {3, 3, 3}, 0.45f));
  Material striped = celled(noisy(0xd9cfb8, 0x8fa3ad, {6, 6, 6}, 0.2f), {0.11f, 40}, 0, 0.9f, 0.004f);
  wallpaper = b.material(striped);
  Material bricks = celled(noisy(0xa9563d, 0x6f3426, {14, 14, 14}, 0.7f), {0.24f, 0.08f}, 0.5f, 0.6f, 0.011f);
  brick = b.material(bricks);
  accent = b.material(noisy(pick(accents), 0x4a5560, {5, 5, 5}, 0.4f));

  Material boards = celled(wood(0xb98a55, 0x7d5430), {0.9f, 0.12f}, 0.37f, 0.7f, 0.003f);
  boards.noise_frequency = {2, 16, 16};
  parquet = b.material(boards);
  carpet = b.material(cloth_of(0x6a6f78, 0x3f444d, 0.02f));
  Material tiled = celled(noisy(0xd8d2c4, 0xa9a090, {7, 7, 7}, 0.6f), {0.4f, 0.4f}, 0, 0.25f, 0.006f);
  tiled.gloss = 0.2f;
  tiled.shininess = 60;
  tiles = b.material(tiled);
  Material panels = celled(noisy(0xe8e8e4, 0xcfcfca, {60, 60, 60}, 0.5f), {0.6f, 0.6f}, 0, 0.1f, 0.012f);
  ceiling = b.material(panels);

  oak = b.material(wood(0xc79a62, 0x8a6238));
  walnut = b.material(wood(0x6a452c, 0x3c2517));
  white_lacquer = b.material(plain(0xdcdcd8, 0.15f));
  white_paint = b.material(plain(0xe4e4e0, 0.08f));
  black_plastic = b.material(noisy(0x1c1d20, 0x2b2d31, {90, 90, 90}, 0.6f));
  grey_plastic = b.material(noisy(0x8d9196, 0x777b80, {70, 70, 70}, 0.6f));
  Material metal = noisy(0x9aa0a6, 0x767c83, {4, 4, 120}, 0.6f);
  metal.gloss = 0.5f;
  metal.shininess = 60;
  steel = b.material(metal);
  Material gold = plain(0xb8923f, 0.5f);
  gold.shininess = 50;
  brass = b.material(gold);
  Material glazed = plain(0xd9e2e6, 0.5f);
  glazed.shininess = 80;
  ceramic = b.material(glazed);
  cardboard = b.material(noisy(0xb08d5f, 0x8f6d42, {3, 3, 60}, 0.6f));
  Material hide = noisy(0x5b3a29, 0x3d251a, {40, 40, 40}, 0.8f);
  hide.gloss = 0.15f;
  leather = b.material(hide);
  soil = b.material(noisy(0x3a2a1e, 0x1f1610, {60, 60, 60}, 1));
  leaf = b.material(noisy(0x4f8a3c, 0x2d5a26, {12, 40, 12}, 0.9f));
  dark_leaf = b.material(noisy(0x2f6a3a, 0x173f22, {12, 40, 12}, 0.9f));
  bark = b.material(noisy(0x6a5138, 0x40301f, {50, 50, 9}, 0.9f));
  terracotta = b.material(noisy(0xb5653f, 0x93492a, {12, 12, 30}, 0.7f));
  const std::array<uint32_t, 3> rugs = {0x7d2f33, 0x2f4f6d, 0x556b3a};
  Material woven = celled(noisy(pick(rugs), 0xcdb58a, {25, 25, 25}, 0.35f), {0.22f, 0.22f}, 0.5f, 1, 0.02f);
  rug = b.material(woven);
  Material shine = plain(0xfff4dc, 0);
  shine.first = shine.second = Vector3f(2.2f, 2.0f, 1.7f);
  shine.emission = 1;
  lamp = b.material(shine);
  cloth = b.material(cloth_of(0xd8d0c0, 0xa89f8d, 0.03f));
  cushion = b.material(cloth_of(pick(accents), 0xe0d6c0, 0.07f));
  screen = b.material(picture(Pattern::Screen, 0x10202c, 0x9fd8c0, 0.8f));
  view = b.material(picture(Pattern::View, 0x4b6a3a, 0x86b4e0, 0.85f));

  for (const auto& [first, second] : {std::pair(0x35506b, 0x22364a), std::pair(0x8a3b32, 0x5f2620),
                                      std::pair(0x4d6b4f, 0x324a35), std::pair(0x5a5560, 0x3a3640)})
    fabrics.push_back(b.material(cloth_of(first, second, 0.012f)));
  for (const auto& [first, second] :
       {std::pair(0xe8c15a, 0xc4532e), std::pair(0x2b5d7d, 0x9ed0c8), std::pair(0xf0e6d2, 0x7a9a5a),
        std::pair(0x49305a, 0xd88a7a), std::pair(0xdadada, 0x6a7a9a)})
    posters.push_back(b.material(picture(Pattern::Poster, first, second, 0)));
  for (const uint32_t colour :
       {0x7a2a24u, 0x264a6au, 0x2f5b3du, 0xc2a14fu, 0x4a3456u, 0xd0c8b6u, 0x23262bu, 0xa85a2cu, 0x5f8a8fu}) {
    Material spine = celled(noisy(colour, colour, {8, 8, 20}, 0.5f), {4, 0.045f}, 0, 0.8f, 0);
    spine.second *= 0.45f;
    books.push_back(b.material(spine));
  }
  for (const uint32_t colour : {0xc23b2eu, 0x2e6fc2u, 0xe0b23au, 0x3aa06au, 0x8a4fb0u, 0xe07a3au}) {
    Material glossy = noisy(colour, colour, {16, 16, 16}, 0.6f);
    glossy.second *= 0.6f;
    glossy.gloss = 0.3f;
    glossy.shininess = 50;
    gaudy.push_back(b.material(glossy));
  }
}

}  // namespace surefield
