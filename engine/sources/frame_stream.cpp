#include "engine/sources/frame_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "engine/types/error.h"

namespace surefield {

namespace {

int count_selected(const Dataset& dataset, const FrameSelection& selection) {
  if (selection.stride < 1) throw InputError("stride must be at least 1");
  if (selection.frames < 0) throw InputError("frames must be 0 (all) or more");
  if (selection.ahead < 1) throw InputError("the number of frames decoded ahead must be at least 1");
  if (!(selection.scale > 0 && selection.scale <= 1)) throw InputError("the image scale must lie in (0, 1]");
  if (selection.start < 0 || selection.start >= dataset.size()) {
    throw InputError(fmt::format("start is {}, but the frames of {} are 0 to {}", selection.start,
                                 dataset.name(), dataset.size() - 1));
  }
  const int available = (dataset.size() - selection.start - 1) / selection.stride + 1;
  return selection.frames == 0 ? available : std::min(available, selection.frames);
}

Intrinsics scaled_intrinsics(const Dataset& dataset, double scale) {
  const Intrinsics intrinsics = dataset.intrinsics().scaled(scale);
  if (intrinsics.width < 1 || intrinsics.height < 1) {
    throw InputError(fmt::format("an image scale of {} leaves no pixel of {}", scale, dataset.name()));
  }
  return intrinsics;
}

}  // namespace

/// The decoding thread and the queue between it and the consumer.
struct FrameStream::Decoder {
  Decoder(const Dataset& source, const FrameSelection& wanted)
      : dataset(source),
        selection(wanted),
        count(count_selected(source, wanted)),
        intrinsics(scaled_intrinsics(source, wanted.scale)),
        thread([this] { run(); }) {}

  ~Decoder() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    changed.notify_all();
    thread.join();
  }

  /// Decodes frame after frame until all are done or the stream is destroyed.
  void run() {
    try {
      for (int n = 0; n < count; ++n) {
        if (!push(decode(selection.start + n * selection.stride))) return;
      }
    } catch (...) {
      // Handed to the consumer, in its place after the frames that were decoded before.
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    finished = true;
    changed.notify_all();
  }

  /// A frame that cannot be decoded is one bad frame; lack of memory is not, and passes through.
  LoadedFrame decode(int index) const {
    LoadedFrame loaded;
    try {
      loaded = dataset.load(index);
      if (loaded.frame) loaded.frame = resize_frame(*loaded.frame, selection.scale);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      loaded = {std::nullopt, error.what()};
    }
    return loaded;
  }

  /// Waits for room in the queue; false when the stream is being destroyed.
  bool push(LoadedFrame loaded) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return stopping || queue.size() < static_cast<std::size_t>(selection.ahead); });
    if (stopping) return false;
    queue.push_back(std::move(loaded));
    changed.notify_all();
    return true;
  }

  /// Waits for the next entry; nullopt after the last.
  std::optional<LoadedFrame> pop() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return finished || !queue.empty(); });
    if (queue.empty()) {
      if (failure) std::rethrow_exception(failure);
      return std::nullopt;
    }
    LoadedFrame loaded = std::move(queue.front());
    queue.pop_front();
    changed.notify_all();
    return loaded;
  }

  const Dataset& dataset;
  const FrameSelection selection;
  const int count;
  const Intrinsics intrinsics;
  int delivered = 0;                  ///< entries taken by the consumer; only the consumer touches it
  std::vector<SkippedFrame> skipped;  ///< only the consumer touches it

  std::mutex mutex;  ///< guards what follows
  std::condition_variable changed;
  std::deque<LoadedFrame> queue;
  bool finished = false;
  bool stopping = false;
  std::exception_ptr failure;
  std::thread thread;  ///< last, so that it starts when all else exists
};

FrameStream::FrameStream(const Dataset& dataset, const FrameSelection& selection)
    : decoder_(std::make_unique<Decoder>(dataset, selection)) {}

FrameStream::~FrameStream() = default;

std::optional<Frame> FrameStream::next() {
  while (std::optional<LoadedFrame> loaded = decoder_->pop()) {
    const int index = decoder_->selection.start + decoder_->delivered++ * decoder_->selection.stride;
    if (loaded->frame) return std::move(loaded->frame);
    decoder_->skipped.push_back({index, std::move(loaded->problem)});
  }
  return std::nullopt;
}

const Intrinsics& FrameStream::intrinsics() const {
  return decoder_->intrinsics;
}

int FrameStream::size() const {
  return decoder_->count;
}

const std::vector<SkippedFrame>& FrameStream::skipped() const {
  return decoder_->skipped;
}

}  // namespace surefield
