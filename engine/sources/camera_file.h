#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/types/camera.h"

namespace surefield {

/// The name of the calibration file that own recordings bring.
inline constexpr const char* kCameraFile = "camera.yaml";

/// How a lens departs from a pinhole, in OpenCV's terms.
struct LensDistortion {
  enum class Model {
    RadialTangential,  ///< k1 k2 p1 p2, then k3, then k4 k5 k6, then s1 s2 s3 s4, then tx ty: 4, 5, 8, 12 or
                       ///< 14
    Fisheye            ///< k1 k2 k3 k4, also called equidistant or Kannala-Brandt
  };
  Model model = Model::RadialTangential;
  std::vector<double> coefficients;  ///< empty where the images have none

  bool empty() const { return coefficients.empty(); }
};

/// A depth camera beside the colour camera.
struct RecordedDepthCamera {
  Intrinsics intrinsics;
  LensDistortion distortion;
  Eigen::Isometry3d depth_to_colour = Eigen::Isometry3d::Identity();  ///< metres
};

/// The camera of a recording.
struct RecordedCamera {
  Intrinsics intrinsics;  ///< width and height are 0 where nobody has said them
  LensDistortion distortion;
  double depth_unit = 0;  ///< metres for one step of the depth images
  std::optional<RecordedDepthCamera> depth_camera =
      std::nullopt;  ///< where depth is not registered to colour
};

/// Reads camera.yaml: fx, fy, cx, cy (pixels, centres at integers) and depth_unit (metres for one step);
/// optionally width and height (pixels, both or none), distortion (a list as in LensDistortion) and
/// distortion_model, "radtan" or "fisheye". Where depth is not registered to colour, the section `depth` has
/// width, height, fx, fy, cx, cy, distortion and distortion_model of the depth camera, and depth_to_colour: a
/// 4 x 4 matrix by rows, metres, that takes a point from the depth camera's frame to the colour camera's.
/// Throws InputError naming the key that is missing, unknown or wrong.
RecordedCamera read_camera_file(const std::filesystem::path& file);

/// Reads the calibration that Open3D's recorders leave, camera_intrinsic.json or intrinsic.json: "width",
/// "height", "intrinsic_matrix" (nine numbers, column after column) and, where it is not 1000, "depth_scale",
/// the steps of a metre. Throws InputError naming the key.
RecordedCamera read_open3d_camera(const std::filesystem::path& file);

/// Reads the calibration of ETH3D's SLAM benchmark, calibration.txt: "fx fy cx cy". The depth unit is TUM's;
/// the size is not said. Throws InputError.
RecordedCamera read_eth3d_camera(const std::filesystem::path& file);

/// A published calibration by its name in known_camera_names(). Throws InputError where there is none of that
/// name.
RecordedCamera known_camera(const std::string& name);

/// "freiburg1", "freiburg2", "freiburg3" (TUM's benchmark), "bonn" (Bonn's RGB-D Dynamic Dataset) and "icl"
/// (ICL-NUIM).
std::vector<std::string> known_camera_names();

}  // namespace surefield
