#include "engine/io/json_file.h"

#include <cmath>
#include <utility>

#include "engine/io/error.h"
#include "engine/io/files.h"
#include "engine/io/images.h"

namespace surefield {

namespace {

int read_side(const JsonObject& object, const std::string& key) {
  const double side = object.positive(key);
  if (side != std::floor(side) || side > kLargestSide) object.fail(key, "must be a whole number of pixels");
  return static_cast<int>(side);
}

}  // namespace

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

void JsonObject::fail(const std::string& key, const std::string& problem) const {
  throw InputError(file_, "\"" + key + "\" " + problem);
}

Intrinsics read_intrinsics(const JsonObject& object, const std::string& width_key,
                           const std::string& height_key) {
  Intrinsics intrinsics;
  intrinsics.width = read_side(object, width_key);
  intrinsics.height = read_side(object, height_key);
  intrinsics.fx = object.positive("fx");
  intrinsics.fy = object.positive("fy");
  intrinsics.cx = object.number("cx");
  intrinsics.cy = object.number("cy");
  return intrinsics;
}

}  // namespace surefield
