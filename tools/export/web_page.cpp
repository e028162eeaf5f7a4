#include "tools/export/web_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/formats/spz.h"
#include "engine/report/html.h"
#include "tools/export/web_page_files.h"

namespace surefield {

namespace {

/// A tenth of a millimetre is finer than any picture shows, but rotations want more.
double rounded(double value) {
  return std::round(value * 1e6) / 1e6;
}

/// Each pose as in TUM's format: tx ty tz qx qy qz qw.
nlohmann::json poses_of(const Trajectory& trajectory) {
  nlohmann::json poses = nlohmann::json::array();
  for (const StampedPose& pose : trajectory) {
    if (!pose.is_finite()) continue;
    const Eigen::Vector3d t = pose.camera_to_world.translation();
    const Eigen::Quaterniond q(pose.camera_to_world.linear());
    poses.push_back({rounded(t.x()), rounded(t.y()), rounded(t.z()), rounded(q.x()), rounded(q.y()),
                     rounded(q.z()), rounded(q.w())});
  }
  return poses;
}

std::string run_json(const WebPageContent& content) {
  const Intrinsics& c = content.camera;
  return nlohmann::json({{"camera",
                          {{"width", c.width},
                           {"height", c.height},
                           {"fx", c.fx},
                           {"fy", c.fy},
                           {"cx", c.cx},
                           {"cy", c.cy}}},
                         {"up", {rounded(content.up.x()), rounded(content.up.y()), rounded(content.up.z())}},
                         {"sh_degree", content.map.sh_degree},
                         {"estimate", poses_of(content.estimate)},
                         {"truth", poses_of(content.truth)},
                         {"keyframes", poses_of(content.keyframes)}})
      .dump();
}

/// The map in base64. Harmonics above degree 0, which the page does not show, stay behind.
std::string map_text(const GaussianCloud& map) {
  const auto stride = static_cast<std::size_t>(sh_coefficients(map.sh_degree)) * 3;
  GaussianCloud plain = map;
  plain.sh_degree = 0;
  plain.sh.resize(3 * map.size());
  for (std::size_t i = 0; i < map.size(); ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      plain.sh[3 * i + channel] = map.sh[i * stride + channel];
  std::ostringstream stream;
  write_spz(stream, "the map of the page", plain);
  return base64(stream.str());
}

/// GaussianCloud::sampling in base64, a byte each, as readMap() in tools/web/spz.js takes it: its logarithm
/// in steps of a twentieth of an octave, 255 one metre; 0 not known.
std::string sampling_text(const GaussianCloud& map) {
  std::string bytes;
  for (float sampling : map.sampling) {
    const double steps =
        sampling > 0 ? std::clamp(255 + 20 * std::log2(static_cast<double>(sampling)), 1.0, 255.0) : 0;
    bytes.push_back(static_cast<char>(static_cast<uint8_t>(std::lround(steps))));
  }
  return base64(bytes);
}

/// Puts `text` wherever `mark` stands.
void fill_in(std::string& page, const std::string& mark, const std::string& text) {
  for (auto at = page.find(mark); at != std::string::npos; at = page.find(mark, at + text.size()))
    page.replace(at, mark.size(), text);
}

}  // namespace

std::string web_page(const WebPageContent& content) {
  const BuiltInFiles& files = web_page_files();
  std::string script;
  for (const char* name : {"spz.js", "graphics.js", "camera.js", "main.js"}) script += files.at(name);
  std::string page = files.at("page.html");
  fill_in(page, "@SCRIPT@", script);
  fill_in(page, "@RUN@", run_json(content));
  fill_in(page, "@MAP@", map_text(content.map));
  fill_in(page, "@SAMPLING@", sampling_text(content.map));
  fill_in(page, "@TITLE@", escape_html(content.title));
  return page;
}

}  // namespace surefield
