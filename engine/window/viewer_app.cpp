#include "engine/window/viewer_app.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/viewer/up_direction.h"

namespace surefield {

namespace {

constexpr double kLiveShare = 0.05;     // of the time that what is new in a run may take to show
constexpr double kLivePatience = 0.05;  // seconds between looks for something new
constexpr double kPatience = 0.25;      // where nothing is new unless the user does something
constexpr double kPlayed = 30;          // recorded frames shown in a second
constexpr double kTurn = 2.5;           // radians that a drag over the window's height turns
constexpr double kScroll = 0.85;        // of the distance that a notch leaves
constexpr double kSpeed = 0.8;          // metres a second while a key is held

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
      window_(input_.title),
      device_(device_options(input_, window_)),
      painter_(device_),
      presenter_(device_, window_.create_surface(device_.window_handles().instance)),
      interface_(window_, device_, presenter_) {
  set_map(std::move(input_.map));
  state_.view.depth_far = static_cast<float>(input_.depth_far);
  state_.running = input_.live != nullptr;
  begin_view();
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
    const bool waits = shown_ == 0 && !repaint_ && (input_.live || !state_.running);
    const UserInput input =
        window_.wait(waits ? (input_.live ? kLivePatience : kPatience) : 0, interface_.has_mouse());
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
    const bool updated = take_updates();
    if (window_.pixels().minCoeff() <= 0) continue;  // minimised
    if (shown_ > 0 || repaint_ || updated) draw(requests);
    fulfil(requests);
    const Clock::time_point done = Clock::now();
    if (updated && !finished_) next_update_ = done + (done - now) * static_cast<int>(1 / kLiveShare - 1);
  }
  if (input_.live && state_.stop_on_close) input_.live->stop();
}

/// Takes what the run has left, where it is time to; returns whether there was anything.
bool ViewerApp::take_updates() {
  if (!input_.live || Clock::now() < next_update_) return false;
  LiveFeed::Update update = input_.live->take();
  finished_ |= update.finished;
  ViewerScene& scene = input_.scene;
  scene.numbers.insert(scene.numbers.end(), update.numbers.begin(), update.numbers.end());
  if (update.map) set_map(std::move(*update.map));
  if (update.scene) {
    update.scene->numbers = std::move(scene.numbers);
    scene = std::move(*update.scene);
    new_sensor_ = true;
  }
  const bool any = update.map || update.scene || !update.numbers.empty();
  repaint_ |= update.map || update.scene;
  return any;
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

/// Moves the camera by hand; returns whether it moved. Whoever drags takes it from where it followed.
bool ViewerApp::move_camera(const UserInput& input, double seconds) {
  const int height = std::max(window_.pixels().y(), 1);
  const Eigen::Vector2d turn = kTurn / height * input.drag_left;
  const bool by_mouse = input.drag_left.norm() + input.drag_right.norm() + std::abs(input.scroll) > 0;
  if (by_mouse && state_.style != CameraStyle::Fly) state_.style = CameraStyle::Orbit;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  if (state_.style == CameraStyle::Fly) {
    const auto axis = [&](int more, int less) { return window_.is_down(more) - window_.is_down(less); };
    along = {static_cast<double>(axis(GLFW_KEY_D, GLFW_KEY_A)),
             static_cast<double>(axis(GLFW_KEY_Q, GLFW_KEY_E)),
             static_cast<double>(axis(GLFW_KEY_W, GLFW_KEY_S))};
    camera_.turn(-turn.x(), -turn.y());
    camera_.move(kSpeed * std::min(seconds, 0.2) * along);
  } else {
    camera_.orbit(turn.x(), turn.y());
  }
  camera_.pan(input.drag_right.x(), input.drag_right.y(), height);
  if (input.scroll != 0) camera_.approach(std::pow(kScroll, input.scroll));
  return by_mouse || along.norm() > 0;
}

/// Puts the camera where it is not moved by hand.
void ViewerApp::place_camera() {
  const SceneFrame& frame = input_.scene.frame;
  if (frame.index < 0) return;
  if (state_.style == CameraStyle::Through || info_of(state_.view.mode).needs_sensor)
    camera_.look_through(frame.camera);
  else if (state_.style == CameraStyle::Follow)
    camera_.follow(frame.camera.world_to_camera.inverse());
}

/// Goes on through a recorded trajectory, from its beginning again after its end.
void ViewerApp::play(double seconds) {
  const int frames = static_cast<int>(input_.scene.trajectory.size());
  if (input_.live || !state_.running || frames < 2) return;
  played_ += kPlayed * seconds;
  const int whole = static_cast<int>(played_);
  played_ -= whole;
  state_.position = (state_.position + whole) % frames;
}

void ViewerApp::choose_frame(int position) {
  ViewerScene& scene = input_.scene;
  state_.position = std::clamp(position, 0, std::max(static_cast<int>(scene.trajectory.size()) - 1, 0));
  if (scene.trajectory.empty() || !scene.trajectory[state_.position].is_finite()) return;
  scene.frame.index = state_.position;
  scene.frame.camera.world_to_camera = scene.trajectory[state_.position].camera_to_world.inverse();
  repaint_ = true;
}

void ViewerApp::jump_keyframes(int count) {
  const ViewerScene& scene = input_.scene;
  if (count == 0 || scene.keyframes.empty() || scene.trajectory.empty()) return;
  const double time =
      scene.trajectory[std::min<std::size_t>(state_.position, scene.trajectory.size() - 1)].timestamp;
  const auto later = [](double t, const StampedPose& pose) { return t < pose.timestamp; };
  const auto next = std::upper_bound(scene.keyframes.begin(), scene.keyframes.end(), time, later);
  const auto here = next - scene.keyframes.begin() - 1;
  const auto last = static_cast<std::ptrdiff_t>(scene.keyframes.size()) - 1;
  const StampedPose& keyframe = scene.keyframes[std::clamp<std::ptrdiff_t>(here + count, 0, last)];
  const auto found = std::lower_bound(scene.trajectory.begin(), scene.trajectory.end(), keyframe.timestamp,
                                      [](const StampedPose& pose, double t) { return pose.timestamp < t; });
  const auto position = static_cast<int>(found - scene.trajectory.begin());
  if (input_.live)
    state_.position = position;
  else
    choose_frame(position);
  camera_.look_through({scene.frame.camera.intrinsics, keyframe.camera_to_world.inverse()});
  state_.style = CameraStyle::Orbit;
  state_.running = state_.running && input_.live;
  repaint_ = true;
}

bool ViewerApp::has_sensor() const {
  return input_.live ? !input_.scene.frame.colour.empty()
                     : input_.load_frame && input_.scene.frame.index >= 0;
}

/// Gives the painter the images of the frame, where a mode needs them.
void ViewerApp::load_sensor() {
  SceneFrame& frame = input_.scene.frame;
  if (!info_of(state_.view.mode).needs_sensor) return;
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

PanelContent ViewerApp::panel_content() const {
  return {.status = input_.scene.status,
          .message = message_,
          .gaussians = painter_.gaussians(),
          .live = input_.live && !finished_,
          .has_sensor = has_sensor(),
          .positions = input_.live ? 0 : static_cast<int>(input_.scene.trajectory.size()),
          .scale = window_.scale(),
          .numbers = &input_.scene.numbers};
}

void ViewerApp::lay_out(ViewerRequests& requests) {
  const ViewerState before = state_;
  std::vector<std::size_t> changed;
  interface_.lay_out([&] {
    if (!state_.interface) return;
    const ViewerRequests asked = draw_panel(panel_content(), state_, input_.settings, changed);
    requests.screenshot |= asked.screenshot;
    requests.save_map |= asked.save_map;
    requests.step |= asked.step;
    requests.reset |= asked.reset;
    requests.stop |= asked.stop;
    requests.keyframes += asked.keyframes;
  });
  for (std::size_t i : changed) input_.live->change(input_.settings[i].key, input_.settings[i].value);
  apply(before);
}

void ViewerApp::paint(const Eigen::Vector2i& window) {
  load_sensor();
  place_camera();
  const Eigen::Vector2i size = (window / state_.coarseness).cwiseMax(1);
  painter_.paint(camera_.camera(size.x(), size.y()), state_.view, lines_of(input_.scene, state_.overlay));
  repaint_ = false;
}

void ViewerApp::draw(ViewerRequests& requests) {
  shown_ = std::max(shown_ - 1, 0);
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
  jump_keyframes(requests.keyframes);
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
