#include "engine/io/dataset.h"

#include <array>
#include <utility>

#include "engine/io/error.h"
#include "engine/io/file_dataset.h"

namespace surefield {

namespace {

struct Layout {
  const char* format;
  const char* looked_for;
  bool (*fits)(const std::filesystem::path&);
  StoredSequence (*read)(const std::filesystem::path&);
};

constexpr std::array<Layout, 3> kLayouts = {{
    {"tum", kTumLayout, is_tum, read_tum_sequence},
    {"replica", kReplicaLayout, is_replica, read_replica_sequence},
    {"sevenscenes", kSevenScenesLayout, is_sevenscenes, read_sevenscenes_sequence},
}};

std::string all_layouts() {
  std::string list;
  for (const Layout& layout : kLayouts) {
    list += (list.empty() ? "" : "; ") + std::string(layout.format) + " has " + layout.looked_for;
  }
  return list;
}

std::string all_formats() {
  std::string list = "auto";
  for (const Layout& layout : kLayouts) list += std::string(", ") + layout.format;
  return list;
}

const Layout& find_layout(const std::filesystem::path& folder, const std::string& format) {
  for (const Layout& layout : kLayouts) {
    const bool fits = layout.fits(folder);
    if (format == "auto" && fits) return layout;
    if (format != layout.format) continue;
    if (fits) return layout;
    throw InputError(folder, "is no sequence of format " + format + ": there is no " + layout.looked_for);
  }
  if (format != "auto")
    throw InputError("unknown dataset format \"" + format + "\"; use one of " + all_formats());
  throw InputError(folder, "no known dataset layout in this folder (" + all_layouts() + ")");
}

}  // namespace

std::unique_ptr<Dataset> open_dataset(const std::filesystem::path& folder, const std::string& format) {
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(folder, "there is no such folder; give the folder of the sequence");
  }
  const std::filesystem::path resolved = std::filesystem::canonical(folder);
  StoredSequence sequence = find_layout(resolved, format).read(resolved);
  return std::make_unique<FileDataset>(std::move(sequence));
}

}  // namespace surefield
