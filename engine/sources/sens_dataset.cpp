// A ScanNet recording that was not exported: one .sens file, given itself or by the folder that holds it.
#include <fmt/format.h>

#include <utility>

#include "engine/io/file_names.h"
#include "engine/io/files.h"
#include "engine/sources/layouts.h"
#include "engine/sources/sens_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr const char* kExtension = ".sens";

std::vector<std::filesystem::path> sens_files(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  if (!folder_exists(path)) {
    if (lower_extension(path) == kExtension) files.push_back(path);
    return files;
  }
  for (const std::filesystem::path& file : list_folder(path))
    if (lower_extension(file) == kExtension) files.push_back(file);
  return files;
}

class SensRecording : public Recording {
 public:
  explicit SensRecording(SensFile sens) : sens_(std::move(sens)) {}

  std::string name() const override { return sens_.file.stem().string(); }
  std::string format() const override { return "scannet"; }
  int count() const override { return static_cast<int>(sens_.frames.size()); }
  Intrinsics intrinsics() const override { return sens_.depth; }
  double depth_unit() const override { return sens_.depth_unit; }
  double timestamp(int i) const override { return i; }

  LoadedFrame load(int i) const override {
    try {
      return {read_sens_frame(sens_, i), ""};
    } catch (const InputError& error) {
      return {std::nullopt, error.what()};
    }
  }

  std::vector<std::string> warnings() const override {
    if (sens_.frames.size() == sens_.promised) return {};
    return {fmt::format("{} ends after {} of {} frames; download it again for the others",
                        sens_.file.string(), sens_.frames.size(), sens_.promised)};
  }

 private:
  SensFile sens_;
};

}  // namespace

bool is_sens(const std::filesystem::path& path) {
  // Beside an exported folder the file may remain; the images are faster to read.
  return !is_scannet(path) && !sens_files(path).empty();
}

Dataset open_sens(const std::filesystem::path& path, const DatasetOptions& options) {
  const auto files = sens_files(path);
  if (files.size() > 1) {
    throw InputError(path, fmt::format("holds {} .sens files; give the path of one of them", files.size()));
  }
  SensFile sens = read_sens_file(files.front());
  if (!options.camera.empty()) throw InputError(path, "brings its camera itself; none can be assumed for it");
  if (options.depth_unit) sens.depth_unit = *options.depth_unit;
  Trajectory truth;
  for (std::size_t i = 0; i < sens.frames.size(); ++i)
    truth.push_back({static_cast<double>(i), sens.frames[i].camera_to_world});
  return {std::make_unique<SensRecording>(std::move(sens)), std::move(truth)};
}

}  // namespace surefield
