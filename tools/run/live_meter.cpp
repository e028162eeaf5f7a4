#include "tools/run/live_meter.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace surefield {

namespace {

/// The value that a share of all does not exceed.
double percentile(std::vector<double> values, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
  const auto place = values.begin() + std::max<std::ptrdiff_t>(0, rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

std::optional<Latency> latency_of(const std::vector<double>& milliseconds) {
  if (milliseconds.empty()) return std::nullopt;
  return Latency{percentile(milliseconds, 0.5), percentile(milliseconds, 0.95)};
}

}  // namespace

void LiveMeter::tracked(const Frame& frame, const FrameReport&) {
  if (!frame.arrived) return;
  using Milliseconds = std::chrono::duration<double, std::milli>;
  from_arrival_.push_back(Milliseconds(std::chrono::steady_clock::now() - *frame.arrived).count());
  if (!unix_stamps_) return;
  const double now = Milliseconds(std::chrono::system_clock::now().time_since_epoch()).count();
  from_stamp_.push_back(now - 1000 * frame.timestamp);
}

std::optional<LiveRecord> LiveMeter::record() const {
  const auto counts = source_ ? source_->live() : std::nullopt;
  if (!counts) return std::nullopt;
  return LiveRecord{*counts, latency_of(from_arrival_), latency_of(from_stamp_)};
}

}  // namespace surefield
