// Recordings written as logs of ROS 2.
#include <array>
#include <cmath>

#include "engine/logs/cdr_writer.h"
#include "engine/logs/mcap_writer.h"
#include "engine/sources/recording_writer.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr const char* kOpticalFrame = "camera_color_optical_frame";  // of both images: they are registered
constexpr const char* kWorldFrame = "map";

// Message definitions, with those that they are made of.
const std::string kRule = std::string(80, '=') + "\n";
const std::string kHeaderText = kRule +
                                "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
                                kRule + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
const std::string kImageText =
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\n"
    "uint8[] data\n" +
    kHeaderText;
const std::string kCameraInfoText =
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\nfloat64[9] "
    "k\n"
    "float64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n" +
    kRule +
    "MSG: sensor_msgs/RegionOfInterest\nuint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\n"
    "bool do_rectify\n" +
    kHeaderText;
const std::string kPoseText =
    "std_msgs/Header header\ngeometry_msgs/Pose pose\n" + kRule +
    "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n" + kRule +
    "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + kRule +
    "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n" + kHeaderText;

/// Split before it is multiplied: seconds since 1970 have no room for nanoseconds.
int64_t nanoseconds(double seconds) {
  const double whole = std::floor(seconds);
  return static_cast<int64_t>(whole) * 1000000000 + std::llround((seconds - whole) * 1e9);
}

class McapRecordingWriter : public RecordingWriter {
 public:
  McapRecordingWriter(const std::filesystem::path& file, const WrittenRecording& recording)
      : recording_(recording),
        mcap_(file),
        info_(mcap_.add_topic("/camera/color/camera_info", "sensor_msgs/msg/CameraInfo", kCameraInfoText)),
        colour_(mcap_.add_topic("/camera/color/image_raw", "sensor_msgs/msg/Image", kImageText)),
        depth_(mcap_.add_topic("/camera/aligned_depth_to_color/image_raw", "sensor_msgs/msg/Image",
                               kImageText)) {}

  void write(const WrittenFrame& frame) override {
    const int64_t stamp = nanoseconds(frame.frame.timestamp);
    mcap_.write(info_, stamp, camera_info(stamp));
    mcap_.write(colour_, stamp, image(stamp, frame.frame.colour, "rgb8"));
    const int64_t depth_stamp = nanoseconds(frame.depth_timestamp);
    mcap_.write(depth_, depth_stamp, image(depth_stamp, frame.frame.depth, "32FC1"));
  }

  void finish(const std::optional<Trajectory>& truth) override {
    if (truth) {
      const uint16_t topic = mcap_.add_topic("/camera/pose", "geometry_msgs/msg/PoseStamped", kPoseText);
      for (const StampedPose& pose : *truth)
        if (pose.is_finite()) mcap_.write(topic, nanoseconds(pose.timestamp), pose_message(pose));
    }
    mcap_.close();
  }

 private:
  std::string camera_info(int64_t stamp) const {
    const Intrinsics& k = recording_.intrinsics;
    CdrWriter writer;
    writer.header(stamp, kOpticalFrame)
        .number(static_cast<uint32_t>(k.height))
        .number(static_cast<uint32_t>(k.width))
        .text("plumb_bob")
        .number(uint32_t{5})
        .doubles(std::array<double, 5>{})
        .doubles(std::array<double, 9>{k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1})
        .doubles(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1})
        .doubles(std::array<double, 12>{k.fx, 0, k.cx, 0, 0, k.fy, k.cy, 0, 0, 0, 1, 0});
    for (int i = 0; i < 6; ++i) writer.number(uint32_t{0});  // binning, region
    return writer.number(uint8_t{0}).bytes();
  }

  static std::string image(int64_t stamp, const cv::Mat& pixels, const char* encoding) {
    const cv::Mat whole = pixels.isContinuous() ? pixels : pixels.clone();
    const std::size_t row = whole.cols * whole.elemSize();
    return CdrWriter()
        .header(stamp, kOpticalFrame)
        .number(static_cast<uint32_t>(whole.rows))
        .number(static_cast<uint32_t>(whole.cols))
        .text(encoding)
        .number(uint8_t{0})
        .number(static_cast<uint32_t>(row))
        .data({reinterpret_cast<const char*>(whole.data), row * whole.rows})
        .bytes();
  }

  static std::string pose_message(const StampedPose& pose) {
    const Eigen::Vector3d t = pose.camera_to_world.translation();
    const Eigen::Quaterniond q(pose.camera_to_world.linear());
    return CdrWriter()
        .header(nanoseconds(pose.timestamp), kWorldFrame)
        .doubles(std::array<double, 7>{t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
        .bytes();
  }

  const WrittenRecording recording_;
  McapWriter mcap_;
  const uint16_t info_, colour_, depth_;
};

}  // namespace

std::unique_ptr<RecordingWriter> write_mcap(const std::filesystem::path& file,
                                            const WrittenRecording& recording) {
  if (std::filesystem::exists(file)) throw InputError(file, "is there already; give another name");
  return std::make_unique<McapRecordingWriter>(file, recording);
}

}  // namespace surefield
