#include "tools/shared/up_option.h"

#include <cstdio>

#include "engine/viewer/view_path.h"

namespace surefield {

namespace {

constexpr const char *kByMap = "auto", *kByCameras = "camera";

/// Three finite numbers with commas between them, not all zero; nullopt for anything else.
std::optional<Eigen::Vector3d> read_direction(const std::string& text) {
  Eigen::Vector3d v;
  int read = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &v.x(), &v.y(), &v.z(), &read) != 3) return std::nullopt;
  if (read != static_cast<int>(text.size()) || !v.allFinite() || v.isZero(0)) return std::nullopt;
  return v.stableNormalized();
}

void read_choice(const std::string& text, UpChoice& choice) {
  if (text == kByMap) {
    choice.way = UpChoice::Way::Map;
  } else if (text == kByCameras) {
    choice.way = UpChoice::Way::Cameras;
  } else if (const auto given = read_direction(text)) {
    choice.way = UpChoice::Way::Given;
    choice.given = *given;
  } else {
    throw CLI::ValidationError(
        "--up " + text +
        " is no direction: give three finite numbers that are not all zero, as in 0,-1,0, or " + kByMap +
        " (as the map's surfaces lie) or " + kByCameras + " (as the cameras were held)");
  }
}

}  // namespace

UpDirection UpChoice::of(const GaussianCloud& map, const Trajectory& trajectory,
                         const std::optional<UpDirection>& recorded) const {
  switch (way) {
    case Way::Given:
      return {.up = given, .measured = false, .given = true};
    case Way::Cameras:
      return {.up = up_of(trajectory)};
    case Way::Map:
      return find_up(map, trajectory);
    default:
      return recorded ? *recorded : find_up(map, trajectory);
  }
}

CLI::Option* add_up_option(CLI::App& command, UpChoice& choice, const std::string& what) {
  return command
      .add_option_function<std::string>(
          "--up", [&choice](const std::string& text) { read_choice(text, choice); }, what)
      ->type_name("X,Y,Z|auto|camera");
}

}  // namespace surefield
