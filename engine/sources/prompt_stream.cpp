#include "engine/sources/prompt_stream.h"

#include <fmt/format.h>

#include <iterator>

#include "engine/types/error.h"

namespace surefield {

PromptStream::PromptStream(FrameSource& source, const FrameSelection& selection)
    : source_(source), selection_(selection), intrinsics_(selected_intrinsics(source, selection)) {
  if (selection.start < 0)
    throw InputError(
        fmt::format("start is {}, but the frames of {} begin at 0", selection.start, source.name()));
}

std::optional<Frame> PromptStream::next() {
  while (selection_.frames == 0 || given_ < selection_.frames) {
    const std::size_t noted = source_.problems().size();
    const std::optional<Frame> frame = source_.next();
    position_ += static_cast<int>(source_.problems().size() - noted);
    give_up_if_hopeless();
    if (!frame) return std::nullopt;
    const int after_start = position_++ - selection_.start;
    if (after_start < 0 || after_start % selection_.stride != 0) continue;
    ++given_;
    return resize_frame(*frame, selection_.scale);
  }
  return std::nullopt;
}

void PromptStream::give_up_if_hopeless() const {
  const auto& problems = source_.problems();
  if (given_ > 0 || selection_.hopeless == 0 || std::ssize(problems) < selection_.hopeless) return;
  throw InputError(
      fmt::format("none of the first {} frames can be read: {}", problems.size(), problems.front().reason));
}

}  // namespace surefield
