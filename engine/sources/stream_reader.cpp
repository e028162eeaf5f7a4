// The framed stream, which docs/live.md describes byte by byte.
#include "engine/sources/stream_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "engine/types/error.h"

namespace surefield {

namespace {

static_assert(std::endian::native == std::endian::little, "the numbers of the stream are little endian");

constexpr uint32_t kStreamVersion = 1;
constexpr std::size_t kMessageHead = 8;  // tag and length
constexpr std::size_t kHeaderBody = 240;
constexpr std::size_t kFrameHead = 32;
constexpr std::size_t kPiece = std::size_t{1} << 20;  // memory grows by so many bytes, as they come
// A compressed image may be a little larger than its pixels, and carry a few words about itself.
constexpr std::size_t kSlack = 65536;
constexpr uint32_t kLargestStreamSide = 8192;
constexpr uint64_t kMostStreamPixels = uint64_t{1} << 25;
constexpr uint32_t kEveryFrame = 1, kWantsPoses = 2, kUnixStamps = 4;
constexpr std::size_t kMostCoefficients = 14;

/// Numbers one after the other.
class Fields {
 public:
  explicit Fields(const std::string& bytes) : at_(bytes.data()) {}

  template <typename T>
  T take() {
    T value{};
    std::memcpy(&value, at_, sizeof(value));
    at_ += sizeof(value);
    return value;
  }
  /// Text that ends with a zero or after `most` bytes, without characters that no name has.
  std::string text(std::size_t most) {
    std::string text(at_, strnlen(at_, most));
    for (char& c : text)
      if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
    at_ += most;
    return text;
  }

 private:
  const char* at_;
};

[[noreturn]] void refuse_header(const std::string& problem) {
  throw InputError("message 1, the header of the stream: " + problem + " (docs/live.md)");
}

void require_between(const char* what, double value, double least, double most) {
  if (!(value >= least && value <= most))
    refuse_header(fmt::format("{} is {:g}; {:g} to {:g} is permitted", what, value, least, most));
}

/// "SFLF", or what stands in its place, as it can be printed.
std::string shown_tag(const std::string& tag) {
  const bool printable = std::all_of(tag.begin(), tag.end(), [](char c) { return c > ' ' && c < 0x7f; });
  if (printable) return fmt::format("\"{}\"", tag);
  std::string text;
  for (char c : tag) text += fmt::format("{}{:02x}", text.empty() ? "" : " ", static_cast<unsigned char>(c));
  return "the bytes " + text;
}

void read_distortion(Fields& fields, LensDistortion& distortion) {
  const auto model = fields.take<uint32_t>();
  const auto count = fields.take<uint32_t>();
  if (model > 1) refuse_header(fmt::format("its model of distortion is {}; there are 0 and 1", model));
  distortion.model = model == 1 ? LensDistortion::Model::Fisheye : LensDistortion::Model::RadialTangential;
  constexpr std::array<uint32_t, 6> kCounts = {0, 4, 5, 8, 12, 14};
  const bool known = std::find(kCounts.begin(), kCounts.end(), count) != kCounts.end();
  if (!known || (model == 1 && count > 4))
    refuse_header(
        fmt::format("it has {} coefficients of distortion; there may be 0, 4, 5, 8, 12 or 14, and "
                    "4 of a fisheye lens",
                    count));
  for (std::size_t i = 0; i < kMostCoefficients; ++i) {
    const auto value = fields.take<double>();
    if (i >= count) continue;
    require_between("a coefficient of distortion", value, -1e3, 1e3);
    distortion.coefficients.push_back(value);
  }
  // A lens without distortion needs no images of its own.
  if (distortion.model == LensDistortion::Model::RadialTangential &&
      std::all_of(distortion.coefficients.begin(), distortion.coefficients.end(),
                  [](double value) { return value == 0; }))
    distortion.coefficients.clear();
}

StreamHeader parse_header(const std::string& body) {
  Fields fields(body);
  const auto version = fields.take<uint32_t>();
  if (version != kStreamVersion)
    refuse_header(fmt::format("it is of version {}, this program reads {}", version, kStreamVersion));
  const auto flags = fields.take<uint32_t>();
  if (flags > (kEveryFrame | kWantsPoses | kUnixStamps))
    refuse_header(fmt::format("its flags, {:#x}, have bits that mean nothing", flags));
  StreamHeader header;
  header.every_frame = flags & kEveryFrame;
  header.wants_poses = flags & kWantsPoses;
  header.unix_stamps = flags & kUnixStamps;
  Intrinsics& k = header.camera.intrinsics;
  const auto width = fields.take<uint32_t>(), height = fields.take<uint32_t>();
  require_between("width", width, 1, kLargestStreamSide);
  require_between("height", height, 1, kLargestStreamSide);
  require_between("the number of pixels", static_cast<double>(uint64_t{width} * height), 1,
                  static_cast<double>(kMostStreamPixels));
  k.width = static_cast<int>(width);
  k.height = static_cast<int>(height);
  for (auto [name, value] : {std::pair{"fx", &k.fx}, {"fy", &k.fy}, {"cx", &k.cx}, {"cy", &k.cy}}) {
    *value = fields.take<double>();
    const bool focal = name[0] == 'f';
    require_between(name, *value, focal ? 1e-3 : -1e6, 1e6);
  }
  header.camera.depth_unit = fields.take<double>();
  require_between("the depth unit, metres for one step,", header.camera.depth_unit, 1e-9, 1e3);
  read_distortion(fields, header.camera.distortion);
  header.name = fields.text(64);
  if (header.name.empty()) header.name = "live";
  return header;
}

std::size_t pixels_of(const StreamHeader& header) {
  const Intrinsics& k = header.camera.intrinsics;
  return static_cast<std::size_t>(k.width) * static_cast<std::size_t>(k.height);
}

std::size_t most_colour(const StreamHeader& header) {
  return 3 * pixels_of(header) + kSlack;
}

std::size_t most_depth(const StreamHeader& header) {
  return 4 * pixels_of(header) + kSlack;
}

}  // namespace

StreamReader::StreamReader(ByteSource& bytes) : bytes_(bytes) {
  ended_ = !read_header();
}

/// Up to so many bytes, fewer where the stream ends.
std::string StreamReader::read_up_to(std::size_t count) {
  std::string bytes;
  std::size_t filled = 0;
  while (filled < count) {
    if (filled == bytes.size()) bytes.resize(std::min(count, filled + kPiece));
    const std::size_t got = bytes_.read(bytes.data() + filled, bytes.size() - filled);
    if (got == 0) break;
    filled += got;
  }
  bytes.resize(filled);
  return bytes;
}

/// False where the source was stopped meanwhile.
bool StreamReader::read_header() {
  message_ = 1;
  const std::string head = read_up_to(kMessageHead);
  if (bytes_.stopped()) return false;
  if (head.empty()) refuse_header("the sender went away before it sent anything");
  if (head.substr(0, 4) != "SFLH")
    refuse_header("begins with " + shown_tag(head.substr(0, 4)) + ", not with \"SFLH\"");
  if (head.size() < kMessageHead) refuse_header("was cut off");
  Fields fields(head);
  fields.take<uint32_t>();
  const auto length = fields.take<uint32_t>();
  if (length != kHeaderBody) refuse_header(fmt::format("has {} bytes where {} belong", length, kHeaderBody));
  const std::string body = read_up_to(kHeaderBody);
  if (bytes_.stopped()) return false;
  if (body.size() < kHeaderBody) refuse_header("was cut off");
  header_ = parse_header(body);
  return true;
}

/// Reads the head of the next message; returns the length of a frame's body, or nullopt at the end.
std::optional<uint32_t> StreamReader::begin_message(std::vector<SkippedFrame>& refused) {
  ++message_;
  const std::string head = read_up_to(kMessageHead);
  if (head.size() < kMessageHead) {
    ended_ = ended_early_ = true;
    if (!head.empty() && !bytes_.stopped())
      refused.push_back({frames_, fmt::format("message {} was cut off", message_)});
    return std::nullopt;
  }
  const std::string tag = head.substr(0, 4);
  if (tag == "SFLE") {
    ended_ = true;
    return std::nullopt;
  }
  if (tag != "SFLF")
    throw InputError(
        fmt::format("message {} of the stream begins with {}, not with \"SFLF\" or \"SFLE\": "
                    "what follows cannot be told apart; is a length wrong that the sender wrote "
                    "before? (docs/live.md)",
                    message_, shown_tag(tag)));
  Fields fields(head);
  fields.take<uint32_t>();
  const auto length = fields.take<uint32_t>();
  const std::size_t most = kFrameHead + most_colour(header_) + most_depth(header_);
  if (length < kFrameHead || length > most)
    throw InputError(
        fmt::format("message {} of the stream claims {} bytes; a frame of {} x {} pixels has {} "
                    "to {} (docs/live.md)",
                    message_, length, header_.camera.intrinsics.width, header_.camera.intrinsics.height,
                    kFrameHead, most));
  return length;
}

/// Why a frame is of no use; nullopt where nothing speaks against it. `colour` and `depth` are the lengths
/// that it claims, `body` what it has for both.
std::optional<std::string> StreamReader::refuse(const StreamFrame& frame, std::size_t colour,
                                                std::size_t depth, std::size_t body) const {
  const auto say = [&](const std::string& problem) {
    return fmt::format("message {}: {}", frame.message, problem);
  };
  if (frame.colour_kind > StreamColour::Png || frame.depth_kind > StreamDepth::Metres32)
    return say(fmt::format("unknown encodings, {} of colour and {} of depth",
                           static_cast<uint32_t>(frame.colour_kind),
                           static_cast<uint32_t>(frame.depth_kind)));
  if (colour + depth != body)
    return say(
        fmt::format("{} bytes of colour and {} of depth are claimed, {} are there", colour, depth, body));
  const std::size_t pixels = pixels_of(header_);
  const bool raw_colour = frame.colour_kind <= StreamColour::Bgr8;
  if (raw_colour ? colour != 3 * pixels : colour > most_colour(header_))
    return say(fmt::format("{} bytes of colour do not fit {} pixels", colour, pixels));
  const std::size_t raw_depth = frame.depth_kind == StreamDepth::Metres32 ? 4 * pixels : 2 * pixels;
  if (frame.depth_kind == StreamDepth::Png16 ? depth > most_depth(header_) : depth != raw_depth)
    return say(fmt::format("{} bytes of depth do not fit {} pixels", depth, pixels));
  if (!std::isfinite(frame.stamp) || !std::isfinite(frame.depth_stamp))
    return say("a stamp is no number of seconds");
  if (any_accepted_ && !(frame.stamp > newest_stamp_))
    return say(fmt::format("its stamp, {:.6f} s, does not lie after that of the frame before, {:.6f} s",
                           frame.stamp, newest_stamp_));
  return std::nullopt;
}

std::optional<StreamFrame> StreamReader::next(std::vector<SkippedFrame>& refused) {
  while (!ended_) {
    const auto length = begin_message(refused);
    if (!length) break;
    StreamFrame frame{.message = message_, .index = frames_++};
    const std::string head = read_up_to(kFrameHead);
    std::string body = head.size() < kFrameHead ? std::string() : read_up_to(*length - kFrameHead);
    if (head.size() + body.size() < *length) {
      ended_ = ended_early_ = true;
      if (!bytes_.stopped())
        refused.push_back({frame.index, fmt::format("message {} was cut off after {} of {} bytes", message_,
                                                    head.size() + body.size(), *length)});
      break;
    }
    frame.arrived = std::chrono::steady_clock::now();
    Fields fields(head);
    frame.colour_kind = static_cast<StreamColour>(fields.take<uint32_t>());
    frame.depth_kind = static_cast<StreamDepth>(fields.take<uint32_t>());
    frame.stamp = fields.take<double>();
    frame.depth_stamp = fields.take<double>();
    const std::size_t colour = fields.take<uint32_t>(), depth = fields.take<uint32_t>();
    if (const auto problem = refuse(frame, colour, depth, body.size())) {
      refused.push_back({frame.index, *problem});
      continue;
    }
    frame.depth = body.substr(colour);
    body.resize(colour);
    frame.colour = std::move(body);
    newest_stamp_ = frame.stamp;
    any_accepted_ = true;
    return frame;
  }
  return std::nullopt;
}

}  // namespace surefield
