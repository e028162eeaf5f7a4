#pragma once

#include <atomic>
#include <new>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "engine/sources/recording.h"

namespace surefield::test {

/// A sequence in memory: frame i is filled with i; some frames fail in different ways.
class FakeRecording : public Recording {
 public:
  explicit FakeRecording(int size) : size_(size) {}
  std::string name() const override { return "fake"; }
  std::string format() const override { return "memory"; }
  int count() const override { return size_; }
  Intrinsics intrinsics() const override { return {8, 6, 10, 10, 3.5, 2.5}; }
  double depth_unit() const override { return 0.001; }
  double timestamp(int i) const override { return i; }

  LoadedFrame load(int i) const override {
    ++loads;
    if (i == missing) return {std::nullopt, "file is missing"};
    if (i == throwing) throw std::runtime_error("decoder failed");
    if (i == out_of_memory) throw std::bad_alloc();
    Frame frame{i, timestamp(i), cv::Mat(6, 8, CV_8UC3, cv::Scalar::all(i)),
                cv::Mat(6, 8, CV_32FC1, cv::Scalar(i))};
    return {frame, ""};
  }

  int missing = -1;
  int throwing = -1;
  int out_of_memory = -1;
  mutable std::atomic<int> loads = 0;

 private:
  int size_;
};

}  // namespace surefield::test
