#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace surefield::gpu {

/// Where pipelines are kept between runs: $XDG_CACHE_HOME/surefield, else ~/.cache/surefield; empty where
/// there is neither.
std::filesystem::path user_cache_folder();

/// The name of the file for one device and driver.
std::string pipeline_file_name(const VkPhysicalDeviceProperties& properties);

/// The data of a VkPipelineCache as write_pipeline_file() has stored it; empty where the file is missing,
/// damaged or of another device or driver.
std::vector<uint8_t> read_pipeline_file(const std::filesystem::path& file,
                                        const VkPhysicalDeviceProperties& properties);

/// Stores the data together with a checksum, making the folder if need be. The file is complete or the old
/// one at any time, also when several processes write it. Returns whether that worked.
bool write_pipeline_file(const std::filesystem::path& file, std::span<const uint8_t> data);

}  // namespace surefield::gpu
