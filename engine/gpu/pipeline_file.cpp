#include "engine/gpu/pipeline_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace surefield::gpu {

namespace {

constexpr char kMagic[8] = {'S', 'U', 'R', 'E', 'P', 'I', 'P', '1'};
constexpr uint64_t kMostBytes = uint64_t{1} << 30;  // more than any driver keeps: the size is damaged

struct FileHeader {
  char magic[8];
  uint64_t bytes;
  uint64_t checksum;
};

/// FNV-1a, so that a torn or damaged file never reaches the driver.
uint64_t checksum(std::span<const uint8_t> data) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (uint8_t byte : data) hash = (hash ^ byte) * 0x100000001b3u;
  return hash;
}

/// Whether the driver's own header says that the data are this device's.
bool fits(std::span<const uint8_t> data, const VkPhysicalDeviceProperties& properties) {
  VkPipelineCacheHeaderVersionOne header;
  if (data.size() < sizeof header) return false;
  std::memcpy(&header, data.data(), sizeof header);
  return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
         header.vendorID == properties.vendorID && header.deviceID == properties.deviceID &&
         std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

}  // namespace

std::filesystem::path user_cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && std::filesystem::path(cache).is_absolute()) return std::filesystem::path(cache) / "surefield";
  const char* home = std::getenv("HOME");
  if (home && *home) return std::filesystem::path(home) / ".cache" / "surefield";
  return {};
}

std::string pipeline_file_name(const VkPhysicalDeviceProperties& properties) {
  std::string name = "pipelines-";
  for (uint8_t byte : properties.pipelineCacheUUID) name += fmt::format("{:02x}", byte);
  return name + fmt::format("-{:x}-{:x}-{:x}.bin", properties.vendorID, properties.deviceID,
                            properties.driverVersion);
}

std::vector<uint8_t> read_pipeline_file(const std::filesystem::path& file,
                                        const VkPhysicalDeviceProperties& properties) {
  std::ifstream stream(file, std::ios::binary);
  FileHeader header{};
  // The size of what was opened: the name may by now stand for another file.
  stream.seekg(0, std::ios::end);
  const auto size = static_cast<uint64_t>(stream.tellg());
  stream.seekg(0);
  if (!stream.read(reinterpret_cast<char*>(&header), sizeof header)) return {};
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0 || header.bytes > kMostBytes ||
      size != sizeof header + header.bytes)
    return {};
  std::vector<uint8_t> data(header.bytes);
  if (!stream.read(reinterpret_cast<char*>(data.data()), static_cast<std::streamsize>(data.size())))
    return {};
  if (checksum(data) != header.checksum || !fits(data, properties)) return {};
  return data;
}

bool write_pipeline_file(const std::filesystem::path& file, std::span<const uint8_t> data) {
  static std::atomic<int> count{0};
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  std::filesystem::path temporary = file;
  temporary += fmt::format(".{}-{}", getpid(), count++);
  FileHeader header{.magic = {}, .bytes = data.size(), .checksum = checksum(data)};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  std::ofstream stream(temporary, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(&header), sizeof header);
  stream.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
  stream.close();
  if (stream) std::filesystem::rename(temporary, file, error);
  if (stream && !error) return true;
  std::filesystem::remove(temporary, error);
  return false;
}

}  // namespace surefield::gpu
