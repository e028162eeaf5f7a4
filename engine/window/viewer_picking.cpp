// What the viewer tells of the map: under the mouse, between two clicks, and over the picture.
#include <fmt/format.h>

#include "engine/viewer/scales.h"
#include "engine/window/viewer_app.h"

namespace surefield {

namespace {

constexpr double kReach =
    5;  // pixels of the window and usual text, from a frustum to the mouse that points to it
constexpr double kMark = 14;     // pixels of the picture, the width of the mark of what was clicked
constexpr double kNormal = 40;   // the same, the length of its normal
constexpr double kRests = 0.15;  // seconds after which a mouse that has not moved rests

}  // namespace

/// What is at a place of the window (pixels), as the picture there shows it.
Under ViewerApp::look_under(const Eigen::Vector2d& place) {
  if (repaint_) paint(window_.pixels());
  if (!measured_) measured_ = painter_.measure(painted_);
  const Intrinsics& k = painted_.intrinsics;
  const Eigen::Vector2d share = place.cwiseQuotient(window_.pixels().cwiseMax(1).cast<double>());
  const Eigen::Vector2d pixel = share.cwiseProduct(Eigen::Vector2d(k.width, k.height));
  Under under{.surface = pick(*measured_, painted_, input_.map, pixel.array().floor().matrix().cast<int>())};
  // Centres of pixels are whole numbers there.
  const Eigen::Vector2d centre = pixel - Eigen::Vector2d::Constant(0.5);
  under.keyframe = keyframe_under(input_.scene, state_.overlay, painted_, under.surface, centre,
                                  kReach * window_.scale() / state_.coarseness);
  return under;
}

void ViewerApp::note(const std::string& text) const {
  if (input_.note) input_.note(text);
}

/// Picks what was clicked, or makes it an end of the ruler.
void ViewerApp::click(const Eigen::Vector2d& place) {
  const Under under = look_under(place);
  repaint_ = true;
  shown_ = 3;
  if (!state_.ruler) {
    picked_ = under;
    note("picked " + describe(under));
    return;
  }
  if (!under.surface) {
    message_ = "there is no surface here to measure from";
    return;
  }
  if (ruler_.size() == 2) ruler_.clear();
  ruler_.push_back(*under.surface);
  if (ruler_.size() == 2) note("measured " + describe_distance(ruler_[0], ruler_[1]));
}

void ViewerApp::forget_picks() {
  picked_.reset();
  ruler_.clear();
  repaint_ = true;
  shown_ = 3;
}

/// Looks under the mouse where it rests on the picture, and the user wants that.
void ViewerApp::probe(const UserInput& input, Clock::time_point now) {
  const Eigen::Vector2d cursor = window_.cursor();
  if (cursor != probed_at_ || input.any) {
    rests_since_ = now;
    if (hint_ && (cursor != probed_at_ || !state_.probe)) {
      hint_.reset();
      shown_ = 3;
    }
    probed_at_ = cursor;
    return;
  }
  const bool rests = std::chrono::duration<double>(now - rests_since_).count() >= kRests;
  if (!state_.probe || hint_ || !rests || interface_.has_mouse() || repaint_) return;
  hint_ = look_under(cursor);
  shown_ = 2;
}

/// The lines of the scene and those of what was clicked.
std::vector<Line> ViewerApp::lines(const Camera& camera) const {
  if (waits_for_map()) return {};
  std::vector<Line> lines = lines_of(input_.scene, state_.overlay);
  if (picked_ && picked_->surface) {
    add_mark(lines, *picked_->surface, camera, kMark);
    add_normal(lines, *picked_->surface, camera, kNormal);
  }
  add_ruler(lines, ruler_, camera);
  return lines;
}

std::string ViewerApp::distance_text() const {
  if (ruler_.size() < 2) return "";
  return "distance " + format_length((ruler_[1].point - ruler_[0].point).norm());
}

double ViewerApp::first_time() const {
  return input_.scene.trajectory.empty() ? 0 : input_.scene.trajectory.front().timestamp;
}

PanelContent ViewerApp::panel_content() const {
  return {
      .status = input_.scene.status,
      .message = message_,
      .gaussians = painter_.gaussians(),
      .live = input_.live != nullptr,
      .has_sensor = has_sensor(),
      .trajectory = &input_.scene.trajectory,
      .keyframes = &input_.scene.keyframes,
      .keyframe = keyframe_shown(),
      .picked = picked_ ? tell(*picked_, input_.scene.keyframes, first_time()) : std::vector<std::string>(),
      .distance = distance_text(),
      .scale = window_.scale(),
      .numbers = &input_.scene.numbers};
}

PictureLabels ViewerApp::labels(Clock::time_point now) const {
  PictureLabels labels{.scales = state_.scales && state_.interface && !waits_for_map(),
                       .legend = legend_of(state_.view),
                       .camera_to_world = camera_.camera_to_world(),
                       .up = camera_.up(),
                       .distance = camera_.distance(),
                       .scale = window_.scale()};
  if (waits_for_map()) {
    const double seconds = std::chrono::duration<double>(now - waits_since_).count();
    labels.waiting = fmt::format("{} ({:.0f} s)", input_.scene.waiting_for, seconds);
  }
  if (!state_.interface || painted_.intrinsics.width == 0) return labels;
  const Eigen::Vector2d window = window_.pixels().cast<double>();
  const Intrinsics& k = painted_.intrinsics;
  labels.metres_a_pixel = camera_.distance() / k.fx * k.width / window.x();
  if (hint_) labels.hint = PlacedText{probed_at_, tell(*hint_, input_.scene.keyframes, first_time())};
  if (ruler_.size() < 2) return labels;
  const Eigen::Vector3d middle = painted_.world_to_camera * (0.5 * (ruler_[0].point + ruler_[1].point));
  if (middle.z() <= 0) return labels;
  const Eigen::Vector2d pixel(k.fx * middle.x() / middle.z() + k.cx + 0.5,
                              k.fy * middle.y() / middle.z() + k.cy + 0.5);
  labels.ruler = PlacedText{pixel * window.x() / k.width, {distance_text()}};
  return labels;
}

}  // namespace surefield
