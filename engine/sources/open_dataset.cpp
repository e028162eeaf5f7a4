#include "engine/sources/open_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "engine/io/file_names.h"
#include "engine/io/files.h"
#include "engine/logs/message_log.h"
#include "engine/sources/file_recording.h"
#include "engine/sources/layouts.h"
#include "engine/sources/stamp_notes.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

using Test = bool (*)(const std::filesystem::path&);

struct Layout {
  const char* format;
  const char* looked_for;
  Test fits;
  Dataset (*open)(const std::filesystem::path&, const DatasetOptions&);
  Test may_fit = fits;  ///< where the user says that it has this layout
};

template <StoredSequence (*Read)(const std::filesystem::path&, const DatasetOptions&)>
Dataset open_files(const std::filesystem::path& folder, const DatasetOptions& options) {
  StoredSequence sequence = Read(folder, options);
  if (options.depth_unit) sequence.depth_encoding.unit = *options.depth_unit;
  const Trajectory* truth = sequence.ground_truth ? &*sequence.ground_truth : nullptr;
  for (std::string& note : notes_on_stamps(stamps_of(sequence), truth))
    sequence.warnings.push_back(std::move(note));
  Dataset dataset;
  dataset.ground_truth = std::move(sequence.ground_truth);
  dataset.recording = std::make_unique<FileRecording>(std::move(sequence));
  return dataset;
}

constexpr std::array<Layout, 10> kLayouts = {{
    {"tum", kTumLayout, is_tum, open_files<read_tum_sequence>},
    {"replica", kReplicaLayout, is_replica, open_files<read_replica_sequence>},
    {"sevenscenes", kSevenScenesLayout, is_sevenscenes, open_files<read_sevenscenes_sequence>},
    {"scannet", kScanNetLayout, is_scannet, open_files<read_scannet_sequence>},
    {"scannet", kSensLayout, is_sens, open_sens},
    {"icl", kIclLayout, is_icl, open_files<read_icl_sequence>, may_be_icl},
    {"plain", kPlainLayout, is_plain, open_files<read_plain_sequence>},
    {"mcap", kMcapLayout, is_mcap, open_log_dataset},
    {"db3", kDb3Layout, is_db3, open_log_dataset},
    {"bag", kBagLayout, is_bag, open_log_dataset},
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

/// Throws InputError where a dataset can be neither in that path nor that path itself.
void require_folder(const std::filesystem::path& path) {
  if (!file_exists(path)) throw InputError(path, "there is no such folder; give the folder of the sequence");
  if (folder_exists(path) || is_sens(path) || !log_files(path).empty()) return;
  const std::string extension = lower_extension(path);
  for (const char* packed : {".zip", ".tar", ".tgz", ".gz", ".7z", ".bz2", ".xz", ".zst", ".zstd"})
    if (extension == packed)
      throw InputError(path, "is packed; unpack it and give the folder of the sequence, or the log");
  for (const char* log : {".oni", ".klg", ".svo"})
    if (extension == log)
      throw InputError(path,
                       "is a recording of a kind that is not read yet; export its images (docs/datasets.md)");
  throw InputError(path, "is a file; give the folder of the sequence (or a .sens, .mcap, .db3 or .bag file)");
}

/// Names a folder in this one that has a layout, as where an archive was unpacked into a folder of its name.
std::string hint_below(const std::filesystem::path& path) {
  for (const std::filesystem::path& below : list_folder(path)) {
    if (!folder_exists(below)) continue;
    for (const Layout& layout : kLayouts)
      if (layout.fits(below))
        return fmt::format("; {} in it has that of {}: give it", below.filename().string(), layout.format);
  }
  return {};
}

const Layout& find_layout(const std::filesystem::path& path, const std::string& format) {
  const std::vector<std::string> formats = dataset_formats();
  if (format != "auto" && std::find(formats.begin(), formats.end(), format) == formats.end()) {
    throw InputError("unknown dataset format \"" + format + "\"; use one of auto, " + join(formats, ", "));
  }
  std::vector<const Layout*> found;
  for (const Layout& layout : kLayouts) {
    if (format == "auto" ? layout.fits(path) : format == layout.format && layout.may_fit(path))
      found.push_back(&layout);
  }
  if (found.size() == 1) return *found.front();
  if (found.empty() && format == "auto") {
    throw InputError(path,
                     "no known dataset layout here (" + describe_layouts(format) + ")" + hint_below(path));
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

Dataset open_dataset(const std::filesystem::path& path, const DatasetOptions& options) {
  require_folder(path);
  std::error_code error;
  const std::filesystem::path resolved = std::filesystem::canonical(path, error);
  if (error) throw InputError(path, "cannot be opened: " + error.message());
  const Layout& layout = find_layout(resolved, options.format);
  const bool names_topics = !options.colour_topic.empty() || !options.depth_topic.empty();
  if (names_topics && layout.open != open_log_dataset)
    throw InputError(path, "has no topics: --colour-topic and --depth-topic are for .mcap, .db3 and .bag");
  return layout.open(resolved, options);
}

}  // namespace surefield
