#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/sources/camera_file.h"
#include "engine/sources/file_recording.h"
#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"

namespace surefield {

// One group for each layout: `is_...` tells from the names of files whether a path has the layout,
// `k...Layout` says what is looked for, `read_..._sequence` (or `open_...`) throws InputError.

inline constexpr const char* kTumLayout = "rgb.txt and depth.txt, or associations.txt";
bool is_tum(const std::filesystem::path& folder);
StoredSequence read_tum_sequence(const std::filesystem::path& folder, const DatasetOptions& options = {});

inline constexpr const char* kReplicaLayout = "results/frame000000.jpg or .png";
bool is_replica(const std::filesystem::path& folder);
StoredSequence read_replica_sequence(const std::filesystem::path& folder, const DatasetOptions& options = {});

inline constexpr const char* kSevenScenesLayout = "frame-000000.color.jpg or .png";
bool is_sevenscenes(const std::filesystem::path& folder);
StoredSequence read_sevenscenes_sequence(const std::filesystem::path& folder,
                                         const DatasetOptions& options = {});

inline constexpr const char* kScanNetLayout = "color/, depth/ and intrinsic/";
bool is_scannet(const std::filesystem::path& folder);
StoredSequence read_scannet_sequence(const std::filesystem::path& folder, const DatasetOptions& options = {});

inline constexpr const char* kSensLayout = "one .sens file";
bool is_sens(const std::filesystem::path& path);
Dataset open_sens(const std::filesystem::path& path, const DatasetOptions& options = {});

inline constexpr const char* kIclLayout = "associations.txt with *.freiburg";
/// Also where nothing but the names of the lists says so, which is enough where the user says the rest.
bool may_be_icl(const std::filesystem::path& folder);
bool is_icl(const std::filesystem::path& folder);
StoredSequence read_icl_sequence(const std::filesystem::path& folder, const DatasetOptions& options = {});

inline constexpr const char* kPlainLayout = "colour/ (or color/, rgb/) and depth/, with camera.yaml";
bool is_plain(const std::filesystem::path& folder);
StoredSequence read_plain_sequence(const std::filesystem::path& folder, const DatasetOptions& options = {});

inline constexpr const char* kMcapLayout = "one .mcap file, or those of one ROS 2 bag";
bool is_mcap(const std::filesystem::path& path);
inline constexpr const char* kDb3Layout = "one .db3 file, or those of one ROS 2 bag";
bool is_db3(const std::filesystem::path& path);
inline constexpr const char* kBagLayout = "one .bag file of ROS 1, or those of one recording";
bool is_bag(const std::filesystem::path& path);
Dataset open_log_dataset(const std::filesystem::path& path, const DatasetOptions& options = {});

/// The list of pairs, "stamp file stamp file", in a folder; nullopt where there is none.
std::optional<std::filesystem::path> find_pair_list(const std::filesystem::path& folder);

/// The frames of such a list, in the order of the colour images' stamps. Throws InputError, also where the
/// names do not tell colour from depth.
std::vector<StoredFrame> read_pair_list(const std::filesystem::path& file, StoredSequence& sequence);

/// The camera that the user gives: that of the options, else camera.yaml in the folder; nullopt where there
/// is none. Adds to the assumptions which it is.
std::optional<RecordedCamera> own_camera(const std::filesystem::path& folder, const DatasetOptions& options,
                                         std::vector<std::string>& assumptions);

/// Takes a camera for that of the sequence, with depth registered to it unless it names a depth camera. Where
/// it has no size, that is the size of the first depth image that can be read.
void use_camera(const RecordedCamera& camera, StoredSequence& sequence);

/// The stamps of all frames, seconds.
std::vector<double> stamps_of(const StoredSequence& sequence);

/// Reads the true poses by `read`, which returns a Trajectory; where they cannot be read, that is a warning.
template <typename Read>
void read_truth(StoredSequence& sequence, Read read) {
  try {
    Trajectory truth = read();
    if (!truth.empty()) sequence.ground_truth = std::move(truth);
  } catch (const InputError& error) {
    sequence.warnings.push_back(std::string("the ground truth is not used: ") + error.what());
  }
}

}  // namespace surefield
