// Which topics of a log are the colour and the depth images of a recording.
#include "engine/sources/log_topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr const char* kImage = "sensor_msgs/Image";
constexpr const char* kCompressedImage = "sensor_msgs/CompressedImage";
constexpr const char* kCameraInfo = "sensor_msgs/CameraInfo";
constexpr std::size_t kNamedTopics = 12;  // in an error

bool has_any(const std::string& name, std::initializer_list<const char*> parts) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::any_of(parts.begin(), parts.end(),
                     [&](const char* part) { return lower.find(part) != std::string::npos; });
}

bool of_another_kind(const std::string& name) {
  return has_any(name, {"infra", "/ir/", "/ir_", "_ir/", "fisheye", "confidence", "mask", "segment",
                        "disparity", "debug", "overlay"});
}

bool says_aligned(const std::string& name) {
  return has_any(name, {"aligned_depth", "depth_to_rgb", "depth_to_color", "depth_registered"});
}

/// What can be told of an image topic by its first message; nullopt where it has none that can be read.
std::optional<LogImageTopic> look_at(const LogReader& log, uint16_t topic) {
  const bool compressed = log.is(topic, kCompressedImage);
  if (!compressed && !log.is(topic, kImage)) return std::nullopt;
  const auto message = log.first(topic);
  if (!message) return std::nullopt;
  LogImageTopic found;
  found.topic = topic;
  found.name = log.topics()[topic].name;
  found.compressed = compressed;
  try {
    if (compressed) {
      const CompressedImageMessage image = read_compressed_image(message->view());
      found.pixels = pixels_of(image);
      found.encoding = image.format;
      found.frame = image.header.frame;
      found.size = size_of_encoded(image);
    } else {
      const ImageStart image = read_image_start(message->view());
      found.pixels = pixels_of(image.encoding);
      found.encoding = image.encoding;
      found.frame = image.header.frame;
      found.size = cv::Size(static_cast<int>(image.width), static_cast<int>(image.height));
    }
  } catch (const InputError&) {
    return std::nullopt;
  }
  return found;
}

struct CameraTopic {
  std::string name;
  CameraInfoMessage camera;
};

std::vector<CameraTopic> camera_topics(const LogReader& log) {
  std::vector<CameraTopic> cameras;
  for (uint16_t topic = 0; topic < log.topics().size(); ++topic) {
    if (!log.is(topic, kCameraInfo)) continue;
    const auto message = log.first(topic);
    if (!message) continue;
    try {
      CameraInfoMessage camera = read_camera_info(message->view());
      // A camera that was not calibrated has only zeros.
      if (camera.intrinsics[0] > 0 && camera.intrinsics[4] > 0)
        cameras.push_back({log.topics()[topic].name, std::move(camera)});
    } catch (const InputError&) {
      continue;
    }
  }
  return cameras;
}

bool same_size(const CameraInfoMessage& camera, cv::Size size) {
  return static_cast<int>(camera.width) == size.width && static_cast<int>(camera.height) == size.height;
}

/// Its sibling by name, else the one that names the same frame and size.
void find_camera(LogImageTopic& image, const std::vector<CameraTopic>& cameras) {
  const CameraTopic* found = nullptr;
  const std::string sibling = camera_topic_of(image.name);
  for (const CameraTopic& camera : cameras)
    if (camera.name == sibling) found = &camera;
  for (const CameraTopic& camera : cameras) {
    const bool fits = !image.frame.empty() && camera.camera.header.frame == image.frame;
    if (!found && fits && same_size(camera.camera, image.size)) found = &camera;
  }
  if (!found) return;
  image.camera = found->camera;
  image.camera_topic = found->name;
}

std::vector<LogImageTopic> image_topics(const LogReader& log) {
  const std::vector<CameraTopic> cameras = camera_topics(log);
  std::vector<LogImageTopic> images;
  for (uint16_t topic = 0; topic < log.topics().size(); ++topic) {
    auto image = look_at(log, topic);
    if (!image) continue;
    find_camera(*image, cameras);
    images.push_back(std::move(*image));
  }
  return images;
}

int colour_score(const LogImageTopic& image) {
  int score = 0;
  if (has_any(image.name, {"color", "colour", "rgb"})) score += 4;
  if (image.camera) score += 3;
  if (image.pixels == LogPixels::Colour) score += 8;
  if (!image.compressed) score += 1;
  if (of_another_kind(image.name)) score -= 12;
  if (has_any(image.name, {"depth"})) score -= 6;
  return score;
}

/// How many parts two names have in common from their beginning: topics of one camera stand together.
int shared_parts(const std::string& a, const std::string& b) {
  const auto [end, ignored] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<int>(std::count(a.begin(), end, '/'));
}

bool is_registered(const LogImageTopic& depth, const LogImageTopic& colour) {
  return says_aligned(depth.name) || (!depth.frame.empty() && depth.frame == colour.frame);
}

int depth_score(const LogImageTopic& image, const LogImageTopic& colour) {
  int score = 2 * std::min(shared_parts(image.name, colour.name), 3);
  if (has_any(image.name, {"depth"})) score += 4;
  if (is_registered(image, colour)) score += 5;
  if (image.camera) score += 2;
  if (!image.compressed) score += 1;
  if (of_another_kind(image.name)) score -= 12;
  return score;
}

std::string names_of(const std::vector<LogImageTopic>& images) {
  std::string names;
  for (const LogImageTopic& image : images) names += (names.empty() ? "" : ", ") + image.name;
  return names.empty() ? "none" : names;
}

/// All topics, for an error that finds no images among them.
std::string topics_text(const LogReader& log) {
  std::string text;
  for (std::size_t i = 0; i < log.topics().size() && i < kNamedTopics; ++i)
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", log.topics()[i].name, log.topics()[i].type);
  if (log.topics().size() > kNamedTopics)
    text += fmt::format(" and {} more", log.topics().size() - kNamedTopics);
  return text.empty() ? "it has no topics at all" : "it has " + text;
}

/// The topic that the user names. Throws InputError where there is none of that name with images.
LogImageTopic named_topic(const LogReader& log, const std::vector<LogImageTopic>& images,
                          const std::string& name, const char* option) {
  for (const LogImageTopic& image : images)
    if (image.name == name) return image;
  const char* problem = log.find(name) ? "holds no images that are read" : "is not in the log";
  throw InputError(log.path(), fmt::format("{} {} {}; its topics with images: {}", option, name, problem,
                                           names_of(images)));
}

/// The best by `score` of those that `fits` lets through; of equals the one with the smaller name.
template <typename Fits, typename Score>
std::optional<LogImageTopic> best_topic(const std::vector<LogImageTopic>& images, Fits fits, Score score,
                                        const char* what, std::vector<std::string>& assumptions) {
  const LogImageTopic* best = nullptr;
  int others = 0;
  for (const LogImageTopic& image : images) {
    if (!fits(image)) continue;
    ++others;
    const bool better =
        !best || score(image) > score(*best) || (score(image) == score(*best) && image.name < best->name);
    if (better) best = &image;
  }
  if (!best) return std::nullopt;
  if (others > 1)
    assumptions.push_back(fmt::format("of {} topics that could be {}, it is {}; --{}-topic names another",
                                      others, what, best->name, what));
  return *best;
}

LogImageTopic choose_colour(const LogReader& log, const std::vector<LogImageTopic>& images,
                            const DatasetOptions& options, LogChoice& choice) {
  if (!options.colour_topic.empty()) return named_topic(log, images, options.colour_topic, "--colour-topic");
  const auto fits = [&](const LogImageTopic& image) {
    return (image.pixels == LogPixels::Colour || image.pixels == LogPixels::Grey) &&
           image.name != options.depth_topic;
  };
  const auto best = best_topic(images, fits, colour_score, "colour", choice.assumptions);
  if (best) return *best;
  throw InputError(log.path(), fmt::format("has no topic with colour images (those with images: {}); {}",
                                           names_of(images), topics_text(log)));
}

LogImageTopic choose_depth(const LogReader& log, const std::vector<LogImageTopic>& images,
                           const DatasetOptions& options, LogChoice& choice) {
  if (!options.depth_topic.empty()) return named_topic(log, images, options.depth_topic, "--depth-topic");
  const auto fits = [&](const LogImageTopic& image) {
    return image.pixels == LogPixels::Depth && image.name != choice.colour.name;
  };
  const auto score = [&](const LogImageTopic& image) { return depth_score(image, choice.colour); };
  const auto best = best_topic(images, fits, score, "depth", choice.assumptions);
  if (best) return *best;
  throw InputError(
      log.path(),
      fmt::format("has no topic with depth images (those with images: {}); depth is 16UC1, mono16, "
                  "32FC1 or compressedDepth",
                  names_of(images)));
}

}  // namespace

std::string camera_topic_of(const std::string& image_topic) {
  const auto parent = [](const std::string& name) { return name.substr(0, name.find_last_of('/')); };
  std::string name = image_topic;
  for (const char* transport : {"/compressed", "/compressedDepth"})
    if (name.ends_with(transport)) name = parent(name);
  if (name.ends_with("/image/data")) return parent(parent(name)) + "/info/camera_info";
  return parent(name) + "/camera_info";
}

LogChoice choose_topics(const LogReader& log, const DatasetOptions& options) {
  const std::vector<LogImageTopic> images = image_topics(log);
  LogChoice choice;
  choice.colour = choose_colour(log, images, options, choice);
  choice.depth = choose_depth(log, images, options, choice);
  choice.aligned = is_registered(choice.depth, choice.colour);
  return choice;
}

}  // namespace surefield
