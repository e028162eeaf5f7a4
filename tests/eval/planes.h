#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "engine/sources/recording.h"

namespace surefield::test {

/// Textured plates that face a camera swaying before them, seen exactly, with calibration as told: a
/// recording of which everything is known.
class PlanesRecording : public Recording {
 public:
  explicit PlanesRecording(int frames = 40, bool moving = true) : moving_(moving) {
    for (int i = 0; i < frames; ++i) truth_.push_back({i / kRate, pose(i / kRate)});
  }

  std::string name() const override { return "planes"; }
  std::string format() const override { return "memory"; }
  int count() const override { return static_cast<int>(truth_.size()); }
  Intrinsics intrinsics() const override { return told; }
  double depth_unit() const override { return 0.001; }
  double timestamp(int i) const override { return i / kRate; }
  /// Null where there is to be none.
  const Trajectory* ground_truth() const { return with_truth ? &truth_ : nullptr; }

  LoadedFrame load(int i) const override {
    Frame frame{i, timestamp(i), cv::Mat(true_camera.height, true_camera.width, CV_8UC3),
                cv::Mat(true_camera.height, true_camera.width, CV_32FC1)};
    const Eigen::Isometry3d colour = pose(i / kRate + image_delay);
    const Eigen::Isometry3d depth = pose(i / kRate + image_delay + depth_delay);
    for (int y = 0; y < true_camera.height; ++y) {
      for (int x = 0; x < true_camera.width; ++x) {
        const auto level = static_cast<uchar>(look(colour, x, y).level);
        frame.colour.at<cv::Vec3b>(y, x) = cv::Vec3b::all(level);
        frame.depth.at<float>(y, x) =
            static_cast<float>(depth_factor * look(depth, x - depth_shift, y).depth);
      }
    }
    return {frame, ""};
  }

  static constexpr double kRate = 30;
  Intrinsics true_camera = {128, 96, 110, 110, 63.5, 47.5};
  Intrinsics told = true_camera;
  double depth_factor = 1;
  double depth_shift = 0;  ///< pixels to the right
  double image_delay = 0;  ///< seconds by which images are taken later than their stamps say
  double depth_delay = 0;  ///< the same for depth alone
  bool with_truth = true;

 private:
  Eigen::Isometry3d pose(double t) const { return sway(moving_ ? t : 0); }

  struct Seen {
    double level = 0;
    double depth = 0;
  };

  /// Sways to and fro, several times a second, so that no two moments are alike.
  static Eigen::Isometry3d sway(double t) {
    const double w = 2 * std::numbers::pi;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(0.25 * std::sin(1.1 * w * t), 0.15 * std::sin(0.7 * w * t + 1),
                                   0.1 * std::sin(0.9 * w * t + 2)));
    pose.rotate(Eigen::AngleAxisd(0.06 * std::sin(0.8 * w * t), Eigen::Vector3d::UnitY()));
    pose.rotate(Eigen::AngleAxisd(0.05 * std::sin(1.3 * w * t + 1), Eigen::Vector3d::UnitX()));
    return pose;
  }

  Seen look(const Eigen::Isometry3d& camera, double x, double y) const {
    struct Plate {
      double left, top, right, bottom, z, base;
    };
    static constexpr std::array<Plate, 5> kPlates = {{{-0.9, -0.6, -0.35, 0.1, 1.4, 40},
                                                      {0.1, -0.5, 0.5, 0.4, 1.7, 200},
                                                      {-0.4, 0.2, 0.2, 0.8, 1.2, 230},
                                                      {0.6, -0.2, 1.1, 0.7, 2.0, 30},
                                                      {-50, -50, 50, 50, 2.8, 120}}};
    const Eigen::Vector3d ray((x - true_camera.cx) / true_camera.fx, (y - true_camera.cy) / true_camera.fy,
                              1);
    const Eigen::Vector3d direction = camera.linear() * ray, origin = camera.translation();
    Seen nearest;
    for (const Plate& plate : kPlates) {
      const double distance = (plate.z - origin.z()) / direction.z();
      const Eigen::Vector3d hit = origin + distance * direction;
      const bool inside =
          hit.x() > plate.left && hit.x() < plate.right && hit.y() > plate.top && hit.y() < plate.bottom;
      if (!inside || (nearest.depth > 0 && distance >= nearest.depth)) continue;
      const double pattern = std::sin(31 * hit.x() + 7 * hit.y()) + std::sin(23 * hit.y() - 11 * hit.x()) +
                             std::sin(53 * hit.x()) * std::sin(47 * hit.y());
      nearest = {std::clamp(plate.base + 16 * pattern, 0.0, 255.0), distance};
    }
    return nearest;
  }

  bool moving_;
  Trajectory truth_;
};

}  // namespace surefield::test
