#include "tools/data/public_datasets.h"

#include <fmt/format.h>

#include "engine/types/error.h"
#include "tools/data/unpack.h"

namespace surefield {

namespace {

constexpr const char* kTumTerms =
    "TUM RGB-D benchmark, CC BY 4.0: cite Sturm et al., IROS 2012; "
    "https://cvg.cit.tum.de/data/datasets/rgbd-dataset";
constexpr const char* kReplicaTerms =
    "Replica, research only: https://github.com/facebookresearch/Replica-Dataset/blob/main/LICENSE; rendered "
    "for "
    "iMAP, hosted for NICE-SLAM";
constexpr const char* kSevenScenesTerms =
    "7-Scenes, Microsoft Research licence, non-commercial use only: "
    "https://www.microsoft.com/en-us/research/project/rgb-d-dataset-7-scenes";

void add_tum(std::vector<PublicDataset>& list, int camera, const std::vector<std::string>& sequences) {
  for (const std::string& sequence : sequences) {
    const std::string folder = fmt::format("rgbd_dataset_freiburg{}_{}", camera, sequence);
    list.push_back({fmt::format("fr{}/{}", camera, sequence),
                    fmt::format("https://cvg.cit.tum.de/rgbd/dataset/freiburg{}/{}.tgz", camera, folder),
                    folder, kTumTerms, ""});
  }
}

std::vector<PublicDataset> make_list() {
  std::vector<PublicDataset> list;
  add_tum(list, 1, {"xyz", "rpy", "360", "floor", "desk", "desk2", "room", "plant", "teddy"});
  add_tum(list, 2, {"xyz", "rpy", "desk", "large_no_loop", "large_with_loop", "desk_with_person"});
  add_tum(list, 3,
          {"long_office_household", "cabinet", "teddy", "structure_texture_near", "structure_texture_far",
           "structure_notexture_near", "nostructure_texture_near_withloop", "sitting_static", "sitting_xyz",
           "walking_static", "walking_xyz"});
  list.push_back(
      {"replica", "https://cvg-data.inf.ethz.ch/nice-slam/data/Replica.zip", "Replica", kReplicaTerms, ""});
  for (const char* scene : {"chess", "fire", "heads", "office", "pumpkin", "redkitchen", "stairs"}) {
    list.push_back(
        {fmt::format("7scenes/{}", scene),
         fmt::format(
             "https://download.microsoft.com/download/2/8/5/28564B23-0828-408F-8631-23B1EFF1DAC8/{}.zip",
             scene),
         scene, kSevenScenesTerms, ""});
  }
  return list;
}

/// The archives of 7-Scenes hold one archive for each sequence.
bool unpack_inner(const std::filesystem::path& folder, const TransferProgress& progress) {
  std::vector<std::filesystem::path> inner;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".zip") inner.push_back(entry.path());
  }
  for (const std::filesystem::path& archive : inner) {
    if (!unpack(archive, archive.parent_path(), progress)) return false;
    std::filesystem::remove(archive);
  }
  return true;
}

/// Unpacks beside the final place and moves the result there.
bool unpack_into_place(const std::filesystem::path& archive, const std::filesystem::path& place,
                       const TransferProgress& progress) {
  const std::filesystem::path staging = place.string() + ".unpacking";
  std::filesystem::remove_all(staging);
  try {
    if (!unpack(archive, staging, progress) || !unpack_inner(staging, progress)) {
      std::filesystem::remove_all(staging);
      return false;
    }
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove_all(staging, ignored);
    throw;
  }
  const std::filesystem::path top = staging / place.filename();
  std::error_code error;
  std::filesystem::rename(std::filesystem::is_directory(top) ? top : staging, place, error);
  if (error) throw InputError(place, "cannot be written: " + error.message());
  std::filesystem::remove_all(staging);
  return true;
}

}  // namespace

const std::vector<PublicDataset>& public_datasets() {
  static const std::vector<PublicDataset> list = make_list();
  return list;
}

const PublicDataset& find_public_dataset(const std::string& name) {
  for (const PublicDataset& dataset : public_datasets()) {
    if (dataset.name == name) return dataset;
  }
  if (name.starts_with("scannet") || name.starts_with("ScanNet") || name.starts_with("scene0")) {
    throw InputError(
        "ScanNet is given only to who signs its terms: fill in the form at http://www.scan-net.org and send "
        "it as "
        "told there; with the script of the answer run `download-scannet.py -o scannet --id scene0000_00 "
        "--type "
        ".sens`, then `surefield run --dataset scannet/scans/scene0000_00`");
  }
  std::string similar;
  for (const PublicDataset& dataset : public_datasets()) {
    if (dataset.name.find(name) != std::string::npos) similar += (similar.empty() ? "" : ", ") + dataset.name;
  }
  throw InputError("there is no dataset " + name + " to fetch" +
                   (similar.empty() ? "" : "; is it one of " + similar + "?") +
                   "; see surefield fetch --list");
}

std::filesystem::path archive_of(const PublicDataset& dataset, const std::filesystem::path& out) {
  return out / std::filesystem::path(dataset.url).filename();
}

Fetched fetch_dataset(const PublicDataset& dataset, const std::filesystem::path& out,
                      const FetchProgress& progress) {
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) throw InputError(out, "cannot be created: " + error.message());
  const std::filesystem::path place = out / dataset.folder;
  if (std::filesystem::exists(place)) return Fetched::AlreadyThere;
  const auto step = [&](const char* name) {
    return [&progress, name](uint64_t done, uint64_t total) { return progress(name, done, total); };
  };
  const std::filesystem::path archive = archive_of(dataset, out);
  if (!download({dataset.url, archive, dataset.sha256}, step("downloading"))) return Fetched::Stopped;
  if (!unpack_into_place(archive, place, step("unpacking"))) return Fetched::Stopped;
  std::filesystem::remove(archive);
  return Fetched::Complete;
}

}  // namespace surefield
