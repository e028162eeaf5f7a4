#include "engine/io/json_file.h"

#include <cmath>
#include <limits>
#include <utility>

#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

JsonObject::JsonObject(const std::filesystem::path& file) : file_(file) {
  try {
    value_ = nlohmann::json::parse(read_file(file));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, std::string("is not valid JSON: ") + error.what());
  }
  if (!value_.is_object()) throw InputError(file, "must hold a JSON object, { ... }");
}

JsonObject::JsonObject(std::filesystem::path file, nlohmann::json value)
    : file_(std::move(file)), value_(std::move(value)) {}

JsonObject JsonObject::object(const std::string& key) const {
  if (!at(key).is_object()) fail(key, "must be an object, { ... }");
  return {file_, at(key)};
}

double JsonObject::number(const std::string& key) const {
  if (!at(key).is_number()) fail(key, "must be a number");
  const double number = at(key).get<double>();
  if (!std::isfinite(number)) fail(key, "must be a finite number");
  return number;
}

double JsonObject::positive(const std::string& key) const {
  const double value = number(key);
  if (value <= 0) fail(key, "must be greater than 0");
  return value;
}

const nlohmann::json& JsonObject::at(const std::string& key) const {
  const auto found = value_.find(key);
  if (found == value_.end()) fail(key, "is missing");
  return *found;
}

std::vector<JsonObject> JsonObject::objects(const std::string& key) const {
  std::vector<JsonObject> list;
  if (!at(key).is_array()) fail(key, "must be a list of objects, [{ ... }, ...]");
  for (const nlohmann::json& value : at(key)) {
    if (!value.is_object()) fail(key, "must be a list of objects, [{ ... }, ...]");
    list.push_back({file_, value});
  }
  return list;
}

Eigen::Vector3d JsonObject::point(const std::string& key) const {
  const nlohmann::json& value = at(key);
  Eigen::Vector3d point = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; value.is_array() && value.size() == 3 && i < 3; ++i)
    if (value[i].is_number()) point[static_cast<Eigen::Index>(i)] = value[i].get<double>();
  if (!point.allFinite()) fail(key, "must be three numbers, [x, y, z]");
  return point;
}

bool JsonObject::has(const std::string& key) const {
  return value_.contains(key);
}

void JsonObject::fail(const std::string& key, const std::string& problem) const {
  throw InputError(file_, "\"" + key + "\" " + problem);
}

}  // namespace surefield
