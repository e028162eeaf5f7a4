#include "engine/viewer/backdrop.h"

#include <array>

namespace surefield {

namespace {

constexpr std::array kBackdrops = {
    BackdropInfo{Backdrop::Squares, "squares"}, BackdropInfo{Backdrop::Dark, "dark"},
    BackdropInfo{Backdrop::Light, "light"}, BackdropInfo{Backdrop::Black, "black"}};

}  // namespace

std::span<const BackdropInfo> backdrops() {
  return kBackdrops;
}

Backdrop next_backdrop(Backdrop backdrop) {
  return kBackdrops[(static_cast<std::size_t>(backdrop) + 1) % kBackdrops.size()].backdrop;
}

void set_backdrop(ViewSettings& settings, Backdrop backdrop) {
  const ViewSettings usual;
  settings.background = usual.background;
  settings.checker = backdrop == Backdrop::Squares ? usual.checker : 0;
  if (backdrop == Backdrop::Light) settings.background = {0.92f, 0.92f, 0.93f};
  if (backdrop == Backdrop::Black) settings.background.setZero();
}

}  // namespace surefield
