// Pipelines are built in the background and kept on disk.
#include <doctest/doctest.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "engine/gpu/error.h"
#include "engine/gpu/pipeline_file.h"
#include "tests/gpu/scale.h"
#include "tests/support/device.h"

using namespace surefield;
using testing::constant_array;

namespace {

/// A fresh folder that goes away with the object.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("surefield_pipelines_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path_))
      if (entry.is_regular_file()) found.push_back(entry.path());
    return found;
  }

 private:
  std::filesystem::path path_;
};

/// A device of vendor 7 with data that its driver might have written.
VkPhysicalDeviceProperties some_device(uint8_t uuid = 1) {
  VkPhysicalDeviceProperties properties{};
  properties.vendorID = 7;
  properties.deviceID = 8;
  properties.driverVersion = 9;
  properties.pipelineCacheUUID[3] = uuid;
  return properties;
}

std::vector<uint8_t> some_data(const VkPhysicalDeviceProperties& properties, std::size_t payload,
                               uint8_t value) {
  VkPipelineCacheHeaderVersionOne header{};
  header.headerSize = sizeof header;
  header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
  header.vendorID = properties.vendorID;
  header.deviceID = properties.deviceID;
  std::memcpy(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE);
  std::vector<uint8_t> data(sizeof header + payload, value);
  std::memcpy(data.data(), &header, sizeof header);
  return data;
}

std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

/// Opens a device that keeps its pipelines in `folder`, runs a pass and closes it again; returns whether the
/// pass did its work.
bool run_with(const std::filesystem::path& folder) {
  gpu::DeviceOptions options = testing::device_options();
  options.cache_folder = folder;
  gpu::Device device(options);
  const testing::Scale scale(device);
  const auto ones = constant_array(device, "ones", 64, 1), values = constant_array(device, "values", 64, 2);
  gpu::Recorder recorder(device);
  scale.record(recorder, ones, values, 64);
  recorder.submit();
  return values.download(64) == std::vector<float>(64, 3.0f) && device.validation_messages().empty();
}

/// Sets an environment variable (or unsets it) for as long as the object lives.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    value ? setenv(name, value, 1) : unsetenv(name);
  }
  ~Environment() { old_ ? setenv(name_, old_->c_str(), 1) : unsetenv(name_); }
  Environment(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

}  // namespace

TEST_CASE("a device leaves one file behind, which the next one takes and leaves as it is") {
  const Folder folder;
  CHECK(run_with(folder.path() / "new" / "folder"));
  const auto files = folder.files();
  REQUIRE(files.size() == 1);
  const std::string content = read(files[0]);
  CHECK(content.size() > sizeof(VkPipelineCacheHeaderVersionOne));
  const auto old_time = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  std::filesystem::last_write_time(files[0], old_time);
  CHECK(run_with(folder.path() / "new" / "folder"));
  CHECK(folder.files() == files);
  CHECK(read(files[0]) == content);
  // Drivers that put times or counters into their data are free to have it written anew; Mesa does not.
  if (testing::device().limits().is_cpu) CHECK(std::filesystem::last_write_time(files[0]) == old_time);
}

TEST_CASE("a damaged file is not given to the driver, and is replaced") {
  const Folder folder;
  CHECK(run_with(folder.path()));
  REQUIRE(folder.files().size() == 1);
  const auto file = folder.files()[0];
  const std::string good = read(file);
  std::string flipped = good;
  flipped[good.size() - 1] = static_cast<char>(flipped[good.size() - 1] ^ 1);
  std::string endless = good;
  endless[14] = 0x7F;  // in the size
  for (const std::string& bad : {std::string(), good.substr(0, 10), good.substr(0, good.size() - 1),
                                 good + "x", flipped, endless, std::string(1000, 'x')}) {
    CAPTURE(bad.size());
    write(file, bad);
    CHECK(run_with(folder.path()));
    CHECK(read(file) == good);
    CHECK(folder.files().size() == 1);
  }
}

TEST_CASE("a folder that cannot be written to, or be made, is no error") {
  const Folder folder;
  write(folder.path() / "file", "");
  CHECK(run_with(folder.path() / "file"));
  CHECK(run_with(folder.path() / "file" / "folder"));
  CHECK_FALSE(gpu::write_pipeline_file(folder.path() / "file" / "folder" / "name", {}));
  CHECK(folder.files().size() == 1);
}

TEST_CASE("what another device or driver has compiled is not taken") {
  const Folder folder;
  const auto file = folder.path() / "pipelines.bin";
  const auto device = some_device();
  const auto data = some_data(device, 100, 5);
  REQUIRE(gpu::write_pipeline_file(file, data));
  CHECK(gpu::read_pipeline_file(file, device) == data);
  auto other = device;
  other.vendorID = 1;
  CHECK(gpu::read_pipeline_file(file, other).empty());
  other = device;
  other.deviceID = 1;
  CHECK(gpu::read_pipeline_file(file, other).empty());
  CHECK(gpu::read_pipeline_file(file, some_device(2)).empty());
  CHECK(gpu::read_pipeline_file(folder.path() / "none", device).empty());
  // Each has a file of its own.
  CHECK(gpu::pipeline_file_name(some_device(2)) != gpu::pipeline_file_name(device));
  other = device;
  other.driverVersion = 10;
  CHECK(gpu::pipeline_file_name(other) != gpu::pipeline_file_name(device));
}

TEST_CASE("writers at the same time leave one whole file, and readers see nothing else") {
  const Folder folder;
  const auto file = folder.path() / "pipelines.bin";
  const auto device = some_device();
  const auto first = some_data(device, 100000, 1), second = some_data(device, 50000, 2);
  REQUIRE(gpu::write_pipeline_file(file, first));
  std::atomic<int> torn{0};
  std::vector<std::thread> threads;
  for (const auto* data : {&first, &second})
    threads.emplace_back([&, data] {
      for (int i = 0; i < 50; ++i) {
        if (!gpu::write_pipeline_file(file, *data)) ++torn;
        const auto seen = gpu::read_pipeline_file(file, device);
        if (seen != first && seen != second) ++torn;
      }
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(torn == 0);
  CHECK(folder.files().size() == 1);
}

TEST_CASE("pipelines are kept in the user's cache folder") {
  const Environment home("HOME", "/home/someone");
  {
    const Environment cache("XDG_CACHE_HOME", "/somewhere/cache");
    CHECK(gpu::user_cache_folder() == "/somewhere/cache/surefield");
  }
  const Environment relative("XDG_CACHE_HOME", "cache");  // to be ignored, says the specification
  CHECK(gpu::user_cache_folder() == "/home/someone/.cache/surefield");
  const Environment none("XDG_CACHE_HOME", nullptr), homeless("HOME", nullptr);
  CHECK(gpu::user_cache_folder().empty());
}

TEST_CASE("many pipelines are built at once, used or not, by threads that do not wait for each other") {
  gpu::Device& device = testing::device();
  std::atomic<int> correct{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&] {
      std::vector<std::unique_ptr<gpu::Pass<passes::test_scale>>> passes;
      for (uint32_t repeats = 1; repeats <= 6; ++repeats)
        passes.push_back(std::make_unique<gpu::Pass<passes::test_scale>>(
            device, 64, passes::test_scale::Constants{.REPEATS = repeats}));
      const auto ones = constant_array(device, "ones", 64, 1), values = constant_array(device, "v", 64, 0);
      gpu::Recorder recorder(device);
      for (int i : {5, 2})
        recorder.dispatch(*passes[static_cast<std::size_t>(i)], 1, {.offsets = ones, .values = values},
                          {.count = 64, .factor = 1});
      recorder.submit();
      if (values.download(64) == std::vector<float>(64, 9.0f)) ++correct;
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(correct == 3);
  device.finish_pipelines();
}

TEST_CASE("what keeps a pipeline from being built is thrown to whoever needs it") {
  gpu::Device& device = testing::device();
  const auto future = device.build_pipeline(
      [](VkPipelineCache) -> VkPipeline { throw gpu::Error(gpu::Error::Kind::Driver, "no such luck"); });
  device.finish_pipelines();
  for (int i = 0; i < 2; ++i) CHECK_THROWS_WITH_AS(future.get(), "no such luck", gpu::Error);
}
