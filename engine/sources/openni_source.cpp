#include "engine/sources/openni_source.h"

#include <OpenNI.h>
#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "engine/io/images.h"
#include "engine/sources/arrival_count.h"
#include "engine/sources/newest_slot.h"
#include "engine/sources/recording.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr int kPatience = 100;                // milliseconds between looks whether the source is stopped
constexpr double kUsualFocalLength = 0.8203;  // of the width: 525 of 640 pixels, as most such cameras have
constexpr double kMicroseconds = 1e-6;

[[noreturn]] void fail(const std::string& what) {
  std::string why = openni::OpenNI::getExtendedError();
  for (char& c : why)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  throw InputError("openni2: " + what + (why.empty() ? "" : ": " + why));
}

/// Has OpenNI2 look for drivers, once. It stays until the process ends: shutting it down crashes in some
/// drivers, Debian's Dummy among them.
void begin_library() {
  static const openni::Status status = openni::OpenNI::initialize();
  if (status != openni::STATUS_OK) fail("OpenNI2 cannot begin");
}

/// A device that is open, with its streams.
struct OpenCamera {
  openni::Device device;
  openni::VideoStream depth, colour;
};

/// Keeps a camera that is no longer used until the process ends: threads of some drivers, Debian's Dummy
/// among them, go on with streams that were destroyed.
void keep(std::unique_ptr<OpenCamera> camera) {
  static std::mutex mutex;
  static auto* const kept = new std::vector<std::unique_ptr<OpenCamera>>;  // never freed, also not at the end
  const std::lock_guard lock(mutex);
  kept->push_back(std::move(camera));
}

/// Both images as the camera gave them.
struct CameraPair {
  int index = 0;
  double stamp = 0;
  double depth_stamp = 0;
  cv::Mat colour;
  cv::Mat steps;
  std::chrono::steady_clock::time_point arrived;
};

/// Tells that a device is gone.
class Disconnection : public openni::OpenNI::DeviceDisconnectedListener {
 public:
  void onDeviceDisconnected(const openni::DeviceInfo* info) override {
    if (uri == info->getUri()) gone = true;
  }
  std::string uri;
  std::atomic<bool> gone{false};
};

class OpenNiSource : public FrameSource {
 public:
  explicit OpenNiSource(const std::string& uri) {
    begin_library();
    if (camera_->device.open(uri.empty() ? openni::ANY_DEVICE : uri.c_str()) != openni::STATUS_OK)
      fail(uri.empty() ? "there is no camera" : uri + " cannot be opened");
    begin(camera_->depth, openni::SENSOR_DEPTH, "depth");
    begin(camera_->colour, openni::SENSOR_COLOR, "colour");
    align();
    describe();
    disconnection_.uri = camera_->device.getDeviceInfo().getUri();
    openni::OpenNI::addDeviceDisconnectedListener(&disconnection_);
    receiver_ = std::thread([this] { receive(); });
  }
  ~OpenNiSource() override {
    stop();
    receiver_.join();
    openni::OpenNI::removeDeviceDisconnectedListener(&disconnection_);
    camera_->depth.stop();
    camera_->colour.stop();
    keep(std::move(camera_));
  }

  std::string name() const override { return name_; }
  std::string format() const override { return "live"; }
  Intrinsics intrinsics() const override { return intrinsics_; }
  std::optional<int> size() const override { return std::nullopt; }
  const std::vector<SkippedFrame>& problems() const override { return problems_; }
  std::vector<std::string> assumptions() const override { return assumptions_; }
  std::optional<LiveCounts> live() const override { return arrivals_.counts(newest_.dropped()); }

  std::optional<Frame> next() override {
    std::optional<CameraPair> pair = newest_.take();
    if (!pair) return std::nullopt;
    const cv::Size size(intrinsics_.width, intrinsics_.height);
    Frame frame{pair->index, pair->stamp, pair->colour, depth_in_metres(pair->steps, {depth_unit_})};
    if (frame.colour.size() != size) cv::resize(pair->colour, frame.colour, size, 0, 0, cv::INTER_AREA);
    frame.depth_after = depth_after(pair->stamp, pair->depth_stamp);
    frame.arrived = pair->arrived;
    return frame;
  }

  void stop() override {
    stopped_ = true;
    newest_.stop();
  }

 private:
  void begin(openni::VideoStream& stream, openni::SensorType sensor, const char* what) {
    if (stream.create(camera_->device, sensor) != openni::STATUS_OK || stream.start() != openni::STATUS_OK)
      fail(fmt::format("the camera gives no {}", what));
  }

  /// Has the device lay depth on colour, and take both at once.
  void align() {
    constexpr auto kOnColour = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    const bool can = camera_->device.isImageRegistrationModeSupported(kOnColour);
    if (!can || camera_->device.setImageRegistrationMode(kOnColour) != openni::STATUS_OK)
      assumptions_.emplace_back(
          "depth is registered to colour already, as the camera cannot be told to do it");
    camera_->device.setDepthColorSyncEnabled(true);  // where it can
  }

  /// Finds out what the images are.
  void describe() {
    const openni::VideoMode mode = camera_->depth.getVideoMode();
    const auto format = mode.getPixelFormat();
    if (format != openni::PIXEL_FORMAT_DEPTH_1_MM && format != openni::PIXEL_FORMAT_DEPTH_100_UM)
      fail("the camera's depth is of an unknown kind");
    if (camera_->colour.getVideoMode().getPixelFormat() != openni::PIXEL_FORMAT_RGB888)
      fail("the camera's colour is no RGB of 8 bits");
    depth_unit_ = format == openni::PIXEL_FORMAT_DEPTH_1_MM ? 1e-3 : 1e-4;
    const int width = mode.getResolutionX(), height = mode.getResolutionY();
    const auto across = static_cast<double>(camera_->colour.getHorizontalFieldOfView());
    const auto down = static_cast<double>(camera_->colour.getVerticalFieldOfView());
    const bool told = across > 0.1 && across < 3 && down > 0.1 && down < 3;
    const double usual = kUsualFocalLength * width;
    intrinsics_ = {width,
                   height,
                   told ? width / (2 * std::tan(across / 2)) : usual,
                   told ? height / (2 * std::tan(down / 2)) : usual,
                   (width - 1) / 2.0,
                   (height - 1) / 2.0};
    if (!told)
      assumptions_.push_back(
          fmt::format("focal lengths are {:.1f} pixels, as the camera does not tell them", usual));
    name_ = camera_->device.getDeviceInfo().getName();
    if (name_.empty()) name_ = "openni2";
  }

  /// The thread: makes pairs of what comes.
  void receive() noexcept {
    std::exception_ptr failure;
    try {
      openni::VideoFrameRef colour, depth;
      while (!stopped_ && !disconnection_.gone) {
        std::array<openni::VideoStream*, 2> streams = {&camera_->depth, &camera_->colour};
        int ready = -1;
        const auto status = openni::OpenNI::waitForAnyStream(streams.data(), 2, &ready, kPatience);
        if (status == openni::STATUS_TIME_OUT) continue;
        if (status != openni::STATUS_OK) break;
        if (streams[static_cast<std::size_t>(ready)]->readFrame(ready == 0 ? &depth : &colour) !=
            openni::STATUS_OK)
          break;
        if (!colour.isValid() || !depth.isValid()) continue;
        put(colour, depth);
        colour.release();
        depth.release();
      }
    } catch (...) {
      failure = std::current_exception();
    }
    newest_.close(failure);
  }

  void put(const openni::VideoFrameRef& colour, const openni::VideoFrameRef& depth) {
    const auto image = [](const openni::VideoFrameRef& frame, int type) {
      // OpenNI2's buffers are its own, and it only reads what it has filled.
      return cv::Mat(frame.getHeight(), frame.getWidth(), type, const_cast<void*>(frame.getData()),
                     static_cast<std::size_t>(frame.getStrideInBytes()))
          .clone();
    };
    CameraPair pair{index_++,
                    static_cast<double>(colour.getTimestamp()) * kMicroseconds,
                    static_cast<double>(depth.getTimestamp()) * kMicroseconds,
                    image(colour, CV_8UC3),
                    image(depth, CV_16UC1),
                    std::chrono::steady_clock::now()};
    if (pair.steps.cols != intrinsics_.width || pair.steps.rows != intrinsics_.height) return;
    arrivals_.add(pair.arrived);
    newest_.put(std::move(pair));
  }

  std::unique_ptr<OpenCamera> camera_ = std::make_unique<OpenCamera>();
  std::string name_;
  Intrinsics intrinsics_;
  double depth_unit_ = kMillimetre;
  std::vector<std::string> assumptions_;
  std::vector<SkippedFrame> problems_;
  Disconnection disconnection_;
  NewestSlot<CameraPair> newest_;
  ArrivalCount arrivals_;
  int index_ = 0;
  std::atomic<bool> stopped_{false};
  std::thread receiver_;
};

}  // namespace

std::unique_ptr<FrameSource> open_openni(const std::string& uri) {
  return std::make_unique<OpenNiSource>(uri);
}

}  // namespace surefield
