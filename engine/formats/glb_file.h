#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace surefield {

/// A binary glTF 2.0 file (.glb) with one node, made in memory and then written.
class GlbFile {
 public:
  GlbFile();

  /// Each adds an array and returns its accessor's number. Arrays must not be empty and hold as many values
  /// as make whole elements of `type` ("SCALAR", "VEC3", ...).
  int add_floats(const std::vector<float>& values, const std::string& type);
  /// Points in our axes; the file has them in glTF's.
  int add_positions(const std::vector<Eigen::Vector3f>& positions);
  /// Colours of pictures (red, green, blue, opacity from 0 to 1); glTF wants them linear.
  int add_colours(const std::vector<std::array<float, 4>>& colours);
  int add_indices(const std::vector<std::array<uint32_t, 3>>& triangles);

  /// Declares an extension. Programs that do not know it may read the file all the same.
  void use_extension(const std::string& name);
  /// The only mesh, shown by the only node. Call it once, or not at all for an empty scene.
  void set_mesh(const std::string& name, nlohmann::json primitive);
  /// Turns the mesh, once it is set, from our axes into those of the scene, and says so in the node's extras.
  void turn_mesh(const Eigen::Matrix3d& world_to_file);
  /// Of the mesh's primitive as its "material" 0.
  void set_material(nlohmann::json material);

  /// Writes the file so that it appears complete or not at all. Throws InputError.
  void write(const std::filesystem::path& file);

 private:
  /// Adds bytes with their accessor, which lacks only the view.
  int add(const void* data, std::size_t bytes, nlohmann::json accessor, int target);

  nlohmann::json json_;
  std::string binary_;
};

}  // namespace surefield
