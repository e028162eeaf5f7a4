#include "engine/sources/stream_source.h"

#include <algorithm>
#include <new>
#include <utility>

#include "engine/types/error.h"

namespace surefield {

StreamSource::StreamSource(std::unique_ptr<ByteSource> bytes)
    : bytes_(std::move(bytes)), reader_(*bytes_), decoder_(reader_.header()) {
  if (!header().every_frame) receiver_ = std::thread([this] { receive(); });
}

StreamSource::~StreamSource() {
  stop();
  if (receiver_.joinable()) receiver_.join();
}

/// The thread where the newest frame wins.
void StreamSource::receive() noexcept {
  std::exception_ptr failure;
  try {
    std::vector<SkippedFrame> refused;
    for (bool more = true; more;) {
      std::optional<StreamFrame> frame = reader_.next(refused);
      {
        const std::lock_guard lock(mutex_);
        refused_.insert(refused_.end(), refused.begin(), refused.end());
      }
      refused.clear();
      more = frame.has_value();
      if (!more) break;
      arrivals_.add(frame->arrived);
      newest_.put(std::move(*frame));
    }
  } catch (...) {
    failure = std::current_exception();
  }
  newest_.close(failure);
}

std::optional<LiveCounts> StreamSource::live() const {
  if (header().every_frame) return std::nullopt;
  return arrivals_.counts(newest_.dropped());
}

std::optional<StreamFrame> StreamSource::next_stored() {
  if (header().every_frame) return reader_.next(problems_);
  std::optional<StreamFrame> stored = newest_.take();
  take_refused();
  return stored;
}

/// Takes over the problems of frames that the thread has passed over.
void StreamSource::take_refused() {
  const std::lock_guard lock(mutex_);
  problems_.insert(problems_.end(), refused_.begin(), refused_.end());
  refused_.clear();
}

std::optional<Frame> StreamSource::next() {
  while (std::optional<StreamFrame> stored = next_stored()) {
    try {
      Frame frame = decoder_.decode(*stored);
      if (!header().every_frame) frame.arrived = stored->arrived;
      return frame;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {
      problems_.push_back({stored->index, describe_current_exception()});
    }
  }
  return std::nullopt;
}

void StreamSource::stop() {
  bytes_->stop();
  newest_.stop();
}

}  // namespace surefield
