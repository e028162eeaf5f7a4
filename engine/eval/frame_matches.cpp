#include "engine/eval/frame_matches.h"

#include <algorithm>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "engine/eval/check_scene.h"

namespace surefield {

namespace {

constexpr double kMatchWidth = 480;        // pixels; finer images take longer and match no better
constexpr int kStarts = 18;                // first frames, spread over the recording
constexpr int kMostFeatures = 500;         // per frame
constexpr double kContrast = 0.02;         // of features; below OpenCV's 0.04: plain rooms have few
constexpr float kDistinct = 0.8f;          // the second-best match must be that much worse
constexpr std::size_t kFewestShared = 40;  // that make a pair
constexpr double kEpipolar = 1.5;          // pixels from the epipolar line
constexpr float kSmooth = 1.06f;           // depths about a point differ by less than this factor
constexpr int kAhead[] = {60, 30, 15, 8};  // frames to the second of a pair, tried in turn

/// A frame's features that have depth.
struct Features {
  std::vector<cv::Point2f> points;  // original pixels
  std::vector<double> depths;
  cv::Mat descriptors;
};

/// The depth at a pixel, where the surface about it is smooth.
std::optional<double> depth_at(const cv::Mat& depth, const cv::Point2f& point) {
  const int x = cvRound(point.x), y = cvRound(point.y);
  constexpr int kAbout = 2;  // pixels
  if (x < kAbout || y < kAbout || x + kAbout >= depth.cols || y + kAbout >= depth.rows) return std::nullopt;
  std::vector<float> values;
  for (int v = y - kAbout; v <= y + kAbout; ++v)
    for (int u = x - kAbout; u <= x + kAbout; ++u)
      if (depth.at<float>(v, u) > 0) values.push_back(depth.at<float>(v, u));
  if (values.size() < 13) return std::nullopt;  // half of them
  std::sort(values.begin(), values.end());
  if (values.back() > kSmooth * values.front()) return std::nullopt;
  return values[values.size() / 2];
}

std::optional<Features> find_features(const Recording& recording, int i) {
  const LoadedFrame loaded = recording.load(i);
  if (!loaded.frame) return std::nullopt;
  cv::Mat grey;
  cv::cvtColor(loaded.frame->colour, grey, cv::COLOR_RGB2GRAY);
  const double scale = std::min(1.0, kMatchWidth / grey.cols);
  if (scale < 1) cv::resize(grey.clone(), grey, {}, scale, scale, cv::INTER_AREA);
  std::vector<cv::KeyPoint> keys;
  cv::Mat descriptors;
  cv::SIFT::create(kMostFeatures, 3, kContrast)->detectAndCompute(grey, cv::noArray(), keys, descriptors);
  Features features;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto place = [&](float at) { return static_cast<float>((at + 0.5) / scale - 0.5); };
    const cv::Point2f point(place(keys[k].pt.x), place(keys[k].pt.y));
    const auto depth = depth_at(loaded.frame->depth, point);
    if (!depth) continue;
    features.points.push_back(point);
    features.depths.push_back(*depth);
    features.descriptors.push_back(descriptors.row(static_cast<int>(k)));
  }
  return features;
}

/// What both show, without what no rigid scene can.
std::vector<PointMatch> match(const Features& from, const Features& to, double pixel) {
  if (from.points.size() < kFewestShared || to.points.size() < kFewestShared) return {};
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_L2).knnMatch(from.descriptors, to.descriptors, nearest, 2);
  std::vector<cv::DMatch> matches;
  for (const auto& two : nearest)
    if (two.size() == 2 && two[0].distance < kDistinct * two[1].distance) matches.push_back(two[0]);
  if (matches.size() < kFewestShared) return {};
  std::vector<cv::Point2f> a, b;
  for (const cv::DMatch& m : matches) {
    a.push_back(from.points[static_cast<std::size_t>(m.queryIdx)]);
    b.push_back(to.points[static_cast<std::size_t>(m.trainIdx)]);
  }
  cv::Mat rigid;
  cv::setRNGSeed(1);
  cv::findFundamentalMat(a, b, cv::FM_RANSAC, kEpipolar * pixel, 0.99, rigid);
  std::vector<PointMatch> points;
  for (std::size_t k = 0; k < matches.size() && !rigid.empty(); ++k) {
    if (rigid.at<uchar>(static_cast<int>(k)) == 0) continue;
    points.push_back({{a[k].x, a[k].y},
                      {b[k].x, b[k].y},
                      from.depths[static_cast<std::size_t>(matches[k].queryIdx)],
                      to.depths[static_cast<std::size_t>(matches[k].trainIdx)]});
  }
  if (points.size() < kFewestShared) points.clear();
  return points;
}

}  // namespace

std::vector<MatchedFrames> match_frames(const Recording& recording, const GoOn& go_on) {
  std::map<int, std::optional<Features>> known;
  const auto features = [&](int i) -> const std::optional<Features>& {
    const auto found = known.find(i);
    return found != known.end() ? found->second : known.emplace(i, find_features(recording, i)).first->second;
  };
  const double pixel = std::max(1.0, recording.intrinsics().width / kMatchWidth);
  std::vector<MatchedFrames> pairs;
  const std::vector<int> starts = spread(recording.count(), kStarts);
  for (std::size_t n = 0; n < starts.size(); ++n) {
    if (go_on && !go_on(static_cast<double>(n) / static_cast<double>(starts.size()))) break;
    const int from = starts[n];
    if (!features(from)) continue;
    for (int ahead : kAhead) {
      const int to = from + ahead;
      if (to >= recording.count() || !features(to)) continue;
      MatchedFrames pair{from, to, match(*features(from), *features(to), pixel)};
      if (pair.points.empty()) continue;
      pairs.push_back(std::move(pair));
      break;
    }
  }
  return pairs;
}

}  // namespace surefield
