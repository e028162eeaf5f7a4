#include "engine/sources/open_dataset.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/sources/file_recording.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

struct Layout {
  const char* format;
  const char* looked_for;
  bool (*fits)(const std::filesystem::path&);
  Dataset (*open)(const std::filesystem::path&, double depth_delay);
};

Dataset dataset_of(StoredSequence sequence) {
  Dataset dataset;
  dataset.ground_truth = std::move(sequence.ground_truth);
  dataset.recording = std::make_unique<FileRecording>(std::move(sequence));
  return dataset;
}

template <StoredSequence (*Read)(const std::filesystem::path&)>
Dataset open_files(const std::filesystem::path& folder, double) {
  return dataset_of(Read(folder));
}

Dataset open_tum(const std::filesystem::path& folder, double depth_delay) {
  return dataset_of(read_tum_sequence(folder, depth_delay));
}

constexpr std::array<Layout, 7> kLayouts = {{
    {"tum", kTumLayout, is_tum, open_tum},
    {"replica", kReplicaLayout, is_replica, open_files<read_replica_sequence>},
    {"sevenscenes", kSevenScenesLayout, is_sevenscenes, open_files<read_sevenscenes_sequence>},
    {"scannet", kScanNetLayout, is_scannet, open_files<read_scannet_sequence>},
    {"scannet", kSensLayout, is_sens, [](const auto& path, double) { return open_sens(path); }},
    {"icl", kIclLayout, is_icl, open_files<read_icl_sequence>},
    {"plain", kPlainLayout, is_plain, open_files<read_plain_sequence>},
}};

std::string join(const std::vector<std::string>& parts, const std::string& separator) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

/// "format has what is looked for" of each layout, of one format or ("auto") of all.
std::string describe_layouts(const std::string& format) {
  std::vector<std::string> list;
  for (const Layout& layout : kLayouts) {
    if (format != "auto" && format != layout.format) continue;
    list.push_back(std::string(layout.format) + " has " + layout.looked_for);
  }
  return join(list, "; ");
}

const Layout& find_layout(const std::filesystem::path& path, const std::string& format) {
  const std::vector<std::string> formats = dataset_formats();
  if (format != "auto" && std::find(formats.begin(), formats.end(), format) == formats.end()) {
    throw InputError("unknown dataset format \"" + format + "\"; use one of auto, " + join(formats, ", "));
  }
  std::vector<const Layout*> found;
  for (const Layout& layout : kLayouts) {
    if ((format == "auto" || format == layout.format) && layout.fits(path)) found.push_back(&layout);
  }
  if (found.size() == 1) return *found.front();
  if (found.empty() && format == "auto") {
    throw InputError(path, "no known dataset layout in this folder (" + describe_layouts(format) + ")");
  }
  if (found.empty()) {
    throw InputError(path, "is no sequence of format " + format + " (" + describe_layouts(format) + ")");
  }
  throw InputError(path, std::string("could be of two layouts, ") + found[0]->format + " (" +
                             found[0]->looked_for + ") and " + found[1]->format + " (" +
                             found[1]->looked_for + "); choose with --format");
}

}  // namespace

std::vector<std::string> dataset_formats() {
  std::vector<std::string> formats;
  for (const Layout& layout : kLayouts) {
    if (formats.empty() || formats.back() != layout.format) formats.push_back(layout.format);
  }
  return formats;
}

Dataset open_dataset(const std::filesystem::path& path, const std::string& format, double depth_delay) {
  if (!std::filesystem::exists(path)) {
    throw InputError(path, "there is no such folder; give the folder of the sequence");
  }
  const std::filesystem::path resolved = std::filesystem::canonical(path);
  return find_layout(resolved, format).open(resolved, depth_delay);
}

}  // namespace surefield
