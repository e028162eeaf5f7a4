#pragma once

#include <filesystem>

#include "engine/sources/file_recording.h"
#include "engine/sources/open_dataset.h"

namespace surefield {

// One group for each layout: `is_...` tells from the names of files whether a path has the layout,
// `k...Layout` says what is looked for, `read_..._sequence` (or `open_...`) throws InputError.

inline constexpr const char* kTumLayout = "rgb.txt and depth.txt";
bool is_tum(const std::filesystem::path& folder);
StoredSequence read_tum_sequence(const std::filesystem::path& folder, double depth_delay);

inline constexpr const char* kReplicaLayout = "results/frame000000.jpg or .png";
bool is_replica(const std::filesystem::path& folder);
StoredSequence read_replica_sequence(const std::filesystem::path& folder);

inline constexpr const char* kSevenScenesLayout = "frame-000000.color.jpg or .png";
bool is_sevenscenes(const std::filesystem::path& folder);
StoredSequence read_sevenscenes_sequence(const std::filesystem::path& folder);

inline constexpr const char* kScanNetLayout = "color/, depth/ and intrinsic/";
bool is_scannet(const std::filesystem::path& folder);
StoredSequence read_scannet_sequence(const std::filesystem::path& folder);

inline constexpr const char* kSensLayout = "one .sens file";
bool is_sens(const std::filesystem::path& path);
Dataset open_sens(const std::filesystem::path& path);

inline constexpr const char* kIclLayout = "associations.txt without rgb.txt";
bool is_icl(const std::filesystem::path& folder);
StoredSequence read_icl_sequence(const std::filesystem::path& folder);

inline constexpr const char* kPlainLayout = "colour/ and depth/ (with camera.yaml)";
bool is_plain(const std::filesystem::path& folder);
StoredSequence read_plain_sequence(const std::filesystem::path& folder);

}  // namespace surefield
