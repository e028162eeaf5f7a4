#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "engine/sources/stream_source.h"

namespace surefield {

/// A live source that was opened.
struct LiveSource {
  std::unique_ptr<FrameSource> source;  ///< null where opening it was stopped
  StreamSource* stream = nullptr;       ///< the same where it is a framed stream, else null
};

/// How a live source is opened.
struct LiveOptions {
  std::stop_token stop;  ///< ends the wait for a sender
  /// Is told where a sender is expected, before the wait for it begins; not called where none is waited for.
  std::function<void(const std::string&)> waiting;
};

/// Opens "-" (a framed stream on standard input), "unix:PATH" or "tcp:ADDRESS:PORT" (one from the first
/// sender that connects there), or "openni2[:URI]" (a camera, the first one there is). Waits until the
/// intrinsics are known. Throws InputError where that is no such address, nothing can be opened there, or
/// what comes is no stream.
LiveSource open_live(const std::string& address, const LiveOptions& options = {});

}  // namespace surefield
