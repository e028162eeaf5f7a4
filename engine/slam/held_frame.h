#pragma once

#include <utility>

#include "engine/splat/engine.h"

namespace surefield {

/// A frame that the engine holds as long as this lives, or for good once keep() was called.
class HeldFrame {
 public:
  HeldFrame(SplatEngine& engine, const FrameView& view) : engine_(&engine), handle_(engine.load(view)) {}
  HeldFrame(HeldFrame&& other) noexcept
      : engine_(std::exchange(other.engine_, nullptr)), handle_(other.handle_) {}
  HeldFrame& operator=(HeldFrame&& other) noexcept {
    std::swap(engine_, other.engine_);
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~HeldFrame() {
    if (engine_) engine_->release(handle_);
  }

  FrameHandle handle() const { return handle_; }
  /// The engine holds the frame from here on.
  FrameHandle keep() {
    engine_ = nullptr;
    return handle_;
  }

 private:
  SplatEngine* engine_;
  FrameHandle handle_;
};

}  // namespace surefield
