#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/synth/synthetic_recording.h"

namespace surefield {

/// How a synthetic sequence is laid out on disk.
enum class SequenceLayout { Replica, Tum };

/// Writes a synthetic sequence into a folder so that open_dataset() reads it back, with mesh.ply, the
/// surfaces of the scene in the same world frame, and synth.json, the settings.
class SequenceWriter {
 public:
  /// Creates the folder and writes all but the frames. Files of an earlier sequence that was written here are
  /// removed. Throws InputError where the folder holds anything else, or cannot be written.
  SequenceWriter(std::filesystem::path folder, SequenceLayout layout, const SyntheticRecording& recording);

  /// Writes frame `i`; frames come in order. Throws InputError.
  void write(int i);

  /// Writes what names the frames that have been written: call it after the last one, also of a sequence that
  /// was broken off. Throws InputError.
  void finish();

 private:
  void write_settings(bool complete) const;
  void write_camera() const;
  void write_tum_lists() const;
  void write_depth(const std::filesystem::path& name, const cv::Mat& metres) const;

  std::filesystem::path folder_;
  SequenceLayout layout_;
  const SyntheticRecording& recording_;
  int written_ = 0;
};

}  // namespace surefield
