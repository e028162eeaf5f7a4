#include "tools/shared/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "tools/shared/say.h"

namespace surefield {

namespace {

constexpr std::chrono::milliseconds kPeriod{100};  // drawing more often would only cost time

}  // namespace

void draw_bar(const std::string& label, double fraction, const std::string& text) {
  constexpr int kWidth = 24;
  const int filled = static_cast<int>(kWidth * std::clamp(fraction, 0.0, 1.0));
  say(stderr, "\r\x1b[K{}[{:#<{}}{:-<{}}] {}", label, "", filled, "", kWidth - filled, text);
  std::fflush(stderr);
}

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label) + " "), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (drawn_) say(stderr, "\n");
}

void ProgressLine::show(double fraction, const std::string& text) {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || (drawn_ && fraction < 1 && now - last_ < kPeriod)) return;
  draw_bar(label_, fraction, text);
  drawn_ = true;
  last_ = now;
}

}  // namespace surefield
