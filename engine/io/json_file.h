#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace surefield {

/// An object of a JSON file, with access that names the file and the key in every error.
class JsonObject {
 public:
  /// Reads a file whose top level is an object. Throws InputError.
  explicit JsonObject(const std::filesystem::path& file);

  /// The object under `key`. Throws InputError when it is missing or no object.
  JsonObject object(const std::string& key) const;

  /// The finite number under `key`. Throws InputError when it is missing or none.
  double number(const std::string& key) const;

  /// The positive number under `key`. Throws InputError when it is missing or none.
  double positive(const std::string& key) const;

  /// The objects in the list under `key`. Throws InputError when it is missing or no such list.
  std::vector<JsonObject> objects(const std::string& key) const;

  /// The three finite numbers under `key`. Throws InputError when they are missing or others.
  Eigen::Vector3d point(const std::string& key) const;

  bool has(const std::string& key) const;

  /// The value under `key`, of any type. Throws InputError when it is missing.
  const nlohmann::json& at(const std::string& key) const;

  /// An error about `key` of this file.
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;

 private:
  JsonObject(std::filesystem::path file, nlohmann::json value);

  std::filesystem::path file_;
  nlohmann::json value_;
};

}  // namespace surefield
