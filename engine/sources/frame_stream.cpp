#include "engine/sources/frame_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <iterator>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "engine/types/error.h"

namespace surefield {

namespace {

void check(const FrameSelection& selection) {
  if (selection.stride < 1) throw InputError("stride must be at least 1");
  if (selection.frames < 0) throw InputError("frames must be 0 (all) or more");
  if (selection.ahead < 1) throw InputError("the number of frames decoded ahead must be at least 1");
  if (!(selection.scale > 0 && selection.scale <= 1)) throw InputError("the image scale must lie in (0, 1]");
}

/// How many frames there are to stream; nullopt where nobody knows how many the source has.
std::optional<int> count_selected(const FrameSource& source, const FrameSelection& selection) {
  check(selection);
  const std::optional<int> size = source.size();
  if (selection.start < 0 || (size && selection.start >= *size)) {
    throw InputError(fmt::format("start is {}, but the frames of {} are 0 to {}", selection.start,
                                 source.name(), size ? std::to_string(*size - 1) : "its end"));
  }
  if (!size) return std::nullopt;
  const int available = (*size - selection.start - 1) / selection.stride + 1;
  return selection.frames == 0 ? available : std::min(available, selection.frames);
}

/// What became of one selected frame.
struct Decoded {
  int index = 0;
  LoadedFrame loaded;
};

/// What `load` gives. A frame that cannot be decoded is one bad frame; lack of memory is not, and passes
/// through.
template <typename Load>
LoadedFrame decode(Load load) {
  try {
    return load();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return {std::nullopt, error.what()};
  }
}

}  // namespace

Intrinsics selected_intrinsics(const FrameSource& source, const FrameSelection& selection) {
  check(selection);
  const Intrinsics intrinsics = source.intrinsics().scaled(selection.scale);
  if (intrinsics.width < 1 || intrinsics.height < 1) {
    throw InputError(
        fmt::format("an image scale of {} leaves no pixel of {}", selection.scale, source.name()));
  }
  return intrinsics;
}

/// The decoding thread and the queue between it and the consumer.
struct FrameStream::Decoder {
  /// `ordered` is the source where it has to be read front to back, else null.
  Decoder(const FrameSource& from, FrameSource* ordered, const FrameSelection& wanted)
      : source(from),
        in_order(ordered),
        selection(wanted),
        count(count_selected(from, wanted)),
        intrinsics(selected_intrinsics(from, wanted)),
        thread([this] { run(); }) {}

  ~Decoder() {
    stop();
    thread.join();
  }

  /// Decodes frame after frame until all are done or the stream is destroyed.
  void run() {
    try {
      if (in_order)
        read_in_order(*in_order);
      else
        load_selected(*source.recording());
    } catch (...) {
      // Handed to the consumer, in its place after the frames that were decoded before.
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    finished = true;
    changed.notify_all();
  }

  void load_selected(const Recording& recording) {
    for (int n = 0; n < *count; ++n) {
      const int index = selection.start + n * selection.stride;
      const auto load = [&] {
        LoadedFrame loaded = recording.load(index);
        if (loaded.frame) loaded.frame = resize_frame(*loaded.frame, selection.scale);
        return loaded;
      };
      if (!push({index, decode(load)})) return;
    }
  }

  void read_in_order(FrameSource& from) {
    std::size_t noted = from.problems().size();
    for (bool more = true; more;) {
      const std::optional<Frame> frame = from.next();
      for (; more && noted < from.problems().size(); ++noted) {
        const SkippedFrame& skipped = from.problems()[noted];
        more = pass(skipped.index, [&] { return LoadedFrame{std::nullopt, skipped.reason}; });
      }
      if (!frame) return;
      more = more && pass(frame->index, [&] {
               return LoadedFrame{resize_frame(*frame, selection.scale), ""};
             });
    }
  }

  /// Pushes what is at the next position of the source if that is selected; false when no more is wanted.
  template <typename Load>
  bool pass(int index, Load load) {
    const int after_start = position++ - selection.start;
    if (after_start < 0 || after_start % selection.stride != 0) return true;
    return push({index, decode(load)}) &&
           (selection.frames == 0 || after_start / selection.stride + 1 < selection.frames);
  }

  /// Waits for room in the queue; false when the stream is being destroyed.
  bool push(Decoded decoded) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return stopping || queue.size() < static_cast<std::size_t>(selection.ahead); });
    if (stopping) return false;
    queue.push_back(std::move(decoded));
    changed.notify_all();
    return true;
  }

  void stop() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    changed.notify_all();
    // A source that is read in order may be waiting for its next frame.
    if (in_order) in_order->stop();
  }

  /// Waits for the next entry; nullopt after the last.
  std::optional<Decoded> pop() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return stopping || finished || !queue.empty(); });
    if (stopping) return std::nullopt;
    if (queue.empty()) {
      if (failure) std::rethrow_exception(failure);
      return std::nullopt;
    }
    Decoded decoded = std::move(queue.front());
    queue.pop_front();
    changed.notify_all();
    return decoded;
  }

  /// Called by the consumer.
  void give_up_if_hopeless() const {
    if (any_given || selection.hopeless == 0 || std::ssize(problems) < selection.hopeless) return;
    throw InputError(
        fmt::format("none of the first {} frames can be read: {}", problems.size(), problems.front().reason));
  }

  const FrameSource& source;
  FrameSource* const in_order;
  const FrameSelection selection;
  const std::optional<int> count;
  const Intrinsics intrinsics;
  std::vector<SkippedFrame> problems;  ///< only the consumer touches it
  bool any_given = false;              ///< so this
  int position = 0;                    ///< of the source that is read in order; only the thread touches it

  std::mutex mutex;  ///< guards what follows
  std::condition_variable changed;
  std::deque<Decoded> queue;
  bool finished = false;
  bool stopping = false;
  std::exception_ptr failure;
  std::thread thread;  ///< last, so that it starts when all else exists
};

FrameStream::FrameStream(const Recording& recording, const FrameSelection& selection)
    : decoder_(std::make_unique<Decoder>(recording, nullptr, selection)) {}

// A recording that is known as a source only can be loaded from as well. Others that have one do not give all
// of its frames.
FrameStream::FrameStream(FrameSource& source, const FrameSelection& selection)
    : decoder_(
          std::make_unique<Decoder>(source, source.recording() == &source ? nullptr : &source, selection)) {}

FrameStream::~FrameStream() = default;

void FrameStream::stop() {
  decoder_->stop();
}

bool FrameStream::idle_within(std::chrono::milliseconds patience) const {
  std::unique_lock lock(decoder_->mutex);
  return decoder_->changed.wait_for(lock, patience, [&] { return decoder_->finished; });
}

std::optional<Frame> FrameStream::next() {
  while (std::optional<Decoded> decoded = decoder_->pop()) {
    if (decoded->loaded.frame) {
      decoder_->any_given = true;
      return std::move(decoded->loaded.frame);
    }
    decoder_->problems.push_back({decoded->index, std::move(decoded->loaded.problem)});
    decoder_->give_up_if_hopeless();
  }
  return std::nullopt;
}

std::string FrameStream::name() const {
  return decoder_->source.name();
}

std::string FrameStream::format() const {
  return decoder_->source.format();
}

Intrinsics FrameStream::intrinsics() const {
  return decoder_->intrinsics;
}

std::optional<int> FrameStream::size() const {
  return decoder_->count;
}

const std::vector<SkippedFrame>& FrameStream::problems() const {
  return decoder_->problems;
}

std::vector<std::string> FrameStream::assumptions() const {
  return decoder_->source.assumptions();
}

std::vector<std::string> FrameStream::warnings() const {
  return decoder_->source.warnings();
}

Pose FrameStream::tracked_to_reference() const {
  return decoder_->source.tracked_to_reference();
}

std::optional<LiveCounts> FrameStream::live() const {
  return decoder_->source.live();
}

const Recording* FrameStream::recording() const {
  return decoder_->source.recording();
}

}  // namespace surefield
