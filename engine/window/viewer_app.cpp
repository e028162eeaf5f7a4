#include "engine/window/viewer_app.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/viewer/up_direction.h"

namespace surefield {

namespace {

constexpr double kLiveShare = 0.05;      // of the time that what is new in a run may take to show
constexpr double kLivePatience = 0.05;   // seconds between looks for something new
constexpr double kPatience = 0.25;       // where nothing is new unless the user does something
constexpr double kPlayPatience = 0.005;  // between looks whether the next recorded frame is due
constexpr double kTick = 0.5;            // seconds between counts of how long it takes to the first map

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

gpu::DeviceOptions device_options(const ViewerInput& input, const GlfwWindow& window) {
  return {.selector = input.engine.device,
          .validate = input.engine.validate,
          .window_extensions = window.instance_extensions()};
}

}  // namespace

ViewerApp::ViewerApp(ViewerInput input)
    : input_(std::move(input)),
      window_(input_.title, input_.ui_scale),
      device_(device_options(input_, window_)),
      painter_(device_),
      presenter_(device_, window_.create_surface(device_.window_handles().instance)),
      interface_(window_, device_, presenter_) {
  open();
  set_map(std::move(input_.map));
  state_.view.depth_far = static_cast<float>(input_.depth_far);
  state_.running = input_.live != nullptr;
  begin_view();
}

/// Shows the window. Its first picture takes a while where kernels are compiled for it, so that it says so.
void ViewerApp::open() {
  gpu::Array<glsl::uint> grey(device_, "first picture", 1);
  gpu::Recorder recorder(device_);
  recorder.fill(grey, 1, 0xFF2B2929);
  recorder.submit();
  const auto present = [&] {
    interface_.lay_out([&] {
      draw_labels({.scales = false, .waiting = "Preparing the first picture", .scale = window_.scale()});
    });
    presenter_.show(grey, {1, 1}, window_.pixels(),
                    [this](VkCommandBuffer commands) { interface_.draw(commands); });
  };
  present();  // hidden, so that the window is not black while that is compiled
  window_.show();
  present();
}

/// In a run, behind the camera; else where all of the map is seen.
void ViewerApp::begin_view() {
  state_.style = input_.live ? CameraStyle::Follow : CameraStyle::Orbit;
  camera_ = {};
  camera_.set_up(input_.up ? *input_.up : find_up(input_.map, input_.scene.trajectory).up);
  if (!input_.scene.trajectory.empty()) {
    choose_frame(0);
    camera_.follow(input_.scene.trajectory.front().camera_to_world);
  } else if (!input_.map.means.empty()) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3f& mean : input_.map.means) middle += mean.cast<double>();
    middle /= static_cast<double>(input_.map.size());
    double spread = 0;
    for (const Eigen::Vector3f& mean : input_.map.means) spread += (mean.cast<double>() - middle).norm();
    camera_.overlook(middle, 2 * spread / static_cast<double>(input_.map.size()));
  } else {
    camera_.follow(Pose::Identity());
  }
}

void ViewerApp::set_map(GaussianCloud map) {
  painter_.assign(map, input_.depth_model);
  input_.map = std::move(map);
}

void ViewerApp::run() {
  Clock::time_point last = Clock::now();
  while (!window_.should_close() && !(input_.interrupted && input_.interrupted())) {
    const bool waits = shown_ == 0 && !repaint_;
    const double patience = input_.live ? kLivePatience : plays() ? kPlayPatience : kPatience;
    const UserInput input = window_.wait(waits ? patience : 0, interface_.has_mouse());
    const Clock::time_point now = Clock::now();
    const double seconds = seconds_between(last, now);
    last = now;
    const ViewerState before = state_;
    ViewerRequests requests;
    handle_keys(input, requests);
    repaint_ |= move_camera(input, seconds);
    if (input.any) shown_ = 3;
    play(seconds);
    apply(before);
    const bool had_map = painter_.gaussians() > 0;
    const bool updated = take_updates();
    if (window_.pixels().minCoeff() <= 0) continue;  // minimised
    if (std::exchange(requests.clear, false)) forget_picks();
    for (const Eigen::Vector2d& place : input.clicks) click(place);
    probe(input, now);
    if (waits_for_map() && seconds_between(last_shown_, now) > kTick) shown_ = std::max(shown_, 1);
    if (shown_ > 0 || repaint_ || updated) draw(requests);
    fulfil(requests);
    const Clock::time_point done = Clock::now();
    if (updated && had_map)  // the first pictures of a map compile kernels
      next_update_ = done + (done - now) * static_cast<int>(1 / kLiveShare - 1);
  }
  if (input_.live && state_.stop_on_close) input_.live->stop();
}

/// Takes what the run has left, where it is time to; returns whether there was anything.
bool ViewerApp::take_updates() {
  if (!input_.live || Clock::now() < next_update_) return false;
  LiveFeed::Update update = input_.live->take();
  ViewerScene& scene = input_.scene;
  scene.numbers.insert(scene.numbers.end(), update.numbers.begin(), update.numbers.end());
  if (update.map) set_map(std::move(*update.map));
  if (update.scene) {
    if (update.scene->waiting_for != scene.waiting_for) waits_since_ = Clock::now();
    update.scene->numbers = std::move(scene.numbers);
    scene = std::move(*update.scene);
    new_sensor_ = true;
  }
  const bool any = update.map || update.scene || !update.numbers.empty();
  repaint_ |= update.map || update.scene;
  if (any) shown_ = 3;  // the panel takes its size from what it held before
  if (update.finished) end_live();
  return any;
}

/// From now on the run is one that was recorded.
void ViewerApp::end_live() {
  input_.live = nullptr;
  input_.settings.clear();
  state_.running = false;
  choose_frame(static_cast<int>(input_.scene.trajectory.size()) - 1);
}

/// Does what changes of the state ask for.
void ViewerApp::apply(const ViewerState& before) {
  if (state_ == before) return;
  repaint_ = true;
  shown_ = 3;
  if (input_.live && state_.running != before.running) input_.live->pause(!state_.running);
  if (!input_.live && state_.position != before.position) choose_frame(state_.position);
}

void ViewerApp::handle_keys(const UserInput& input, ViewerRequests& requests) {
  if (interface_.has_keyboard()) return;
  for (const UserInput::Press& press : input.presses) press_key(press.key, state_, requests);
}

ViewMode ViewerApp::shown_mode() const {
  return waits_for_map() && has_sensor() ? ViewMode::Sensor : state_.view.mode;
}

bool ViewerApp::has_sensor() const {
  const SceneFrame& frame = input_.scene.frame;
  return !frame.colour.empty() || (input_.load_frame && frame.index >= 0);
}

/// Gives the painter the images of the frame, where a mode needs them.
void ViewerApp::load_sensor() {
  SceneFrame& frame = input_.scene.frame;
  if (!info_of(shown_mode()).needs_sensor) return;
  if (!input_.live && input_.load_frame && loaded_position_ != state_.position) {
    std::optional<SceneFrame> loaded = input_.load_frame(state_.position);
    frame.colour = loaded ? loaded->colour : cv::Mat();
    frame.depth = loaded ? loaded->depth : cv::Mat();
    loaded_position_ = state_.position;
    new_sensor_ = true;
  }
  if (frame.colour.empty()) {
    message_ = fmt::format("there is no image for \"{}\"", info_of(state_.view.mode).title);
    state_.view.mode = ViewMode::Colour;
    return;
  }
  if (!new_sensor_) return;
  painter_.set_sensor({.width = frame.colour.cols,
                       .height = frame.colour.rows,
                       .colour = frame.colour.data,
                       .depth = frame.depth.ptr<float>()},
                      frame.camera.intrinsics);
  new_sensor_ = false;
}

void ViewerApp::lay_out(ViewerRequests& requests) {
  const ViewerState before = state_;
  std::vector<std::size_t> changed;
  interface_.lay_out([&] {
    draw_labels(labels(Clock::now()));
    if (!state_.interface) return;
    const ViewerRequests asked = draw_panel(panel_content(), state_, input_.settings, changed);
    requests.add(asked);
  });
  for (std::size_t i : changed) input_.live->change(input_.settings[i].key, input_.settings[i].value);
  apply(before);
}

void ViewerApp::paint(const Eigen::Vector2i& window) {
  load_sensor();
  place_camera();
  const Eigen::Vector2i size = (window / state_.coarseness).cwiseMax(1);
  painted_ = camera_.camera(size.x(), size.y());
  ViewSettings view = state_.view;
  view.mode = shown_mode();
  painter_.paint(painted_, view, lines(painted_));
  measured_.reset();
  hint_.reset();
  repaint_ = false;
}

void ViewerApp::draw(ViewerRequests& requests) {
  shown_ = std::max(shown_ - 1, 0);
  last_shown_ = Clock::now();
  lay_out(requests);
  const Eigen::Vector2i window = window_.pixels();
  const Eigen::Vector2i size = (window / state_.coarseness).cwiseMax(1);
  const bool fits = painter_.size().width == static_cast<uint32_t>(size.x()) &&
                    painter_.size().height == static_cast<uint32_t>(size.y());
  if (repaint_ || !fits) paint(window);
  presenter_.show(painter_.pixels(), painter_.size(), window,
                  [this](VkCommandBuffer commands) { interface_.draw(commands); });
}

void ViewerApp::fulfil(const ViewerRequests& requests) {
  if (requests.reset) begin_view();
  if (requests.step && input_.live) input_.live->step();
  if (requests.step && !input_.live) choose_frame(state_.position + 1);
  if (requests.stop && input_.live) input_.live->stop();
  if (requests.keyframes != 0) go_to_keyframe(keyframe_shown() + requests.keyframes);
  if (requests.keyframe >= 0) go_to_keyframe(requests.keyframe);
  if (requests.clear) forget_picks();
  jump_seconds(requests.seconds);
  if (requests.screenshot) save_screenshot();
  if (requests.save_map) save_map();
  if (requests.close) window_.close();
  repaint_ |= requests.reset;
  if (requests.screenshot || requests.save_map || requests.reset) shown_ = 3;
}

std::string viewer_problem() {
  return glfw_problem();
}

std::vector<std::string> show_viewer(ViewerInput input) {
  ViewerApp app(std::move(input));
  app.run();
  return app.validation_messages();
}

}  // namespace surefield
