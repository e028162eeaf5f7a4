#include "engine/viewer/film_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "engine/io/file_names.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr const char* kMpeg4 = ".mp4";
constexpr const char* kMotionJpeg = ".avi";

/// While it lives, OpenCV does not print what its codecs say.
class QuietCodecs {
 public:
  QuietCodecs() : level_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~QuietCodecs() { cv::utils::logging::setLogLevel(level_); }
  QuietCodecs(const QuietCodecs&) = delete;
  QuietCodecs& operator=(const QuietCodecs&) = delete;

 private:
  cv::utils::logging::LogLevel level_;
};

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder, "cannot be created: " + error.message());
}

std::string picture_name(int number) {
  return fmt::format("{:06}.png", number);
}

}  // namespace

struct FilmWriter::Encoder {
  cv::VideoWriter writer;
  cv::Rect part;  ///< of the pictures, that the film shows
};

FilmWriter::FilmWriter(std::filesystem::path file, double rate) : output_(std::move(file)), rate_(rate) {
  const std::string ending = output_.extension().string();
  if (ending.empty()) {
    start_series(output_);
    return;
  }
  if (ending != kMpeg4 && ending != kMotionJpeg)
    throw InputError(output_,
                     "films end in .mp4 or .avi; for a series of PNGs, give a folder, without an ending");
  if (std::filesystem::is_directory(output_)) throw InputError(output_, "is a folder; a film needs a file");
  make_folder(output_.parent_path());
  encoder_ = std::make_unique<Encoder>();
}

FilmWriter::~FilmWriter() {
  const QuietCodecs quiet;
  encoder_.reset();
}

void FilmWriter::start_series(const std::filesystem::path& folder) {
  encoder_.reset();
  output_ = folder;
  make_folder(folder);
}

void FilmWriter::open(const cv::Size& size) {
  const QuietCodecs quiet;
  encoder_->part = {0, 0, size.width / 2 * 2, size.height / 2 * 2};
  const int codec = output_.extension() == kMotionJpeg ? cv::VideoWriter::fourcc('M', 'J', 'P', 'G')
                                                       : cv::VideoWriter::fourcc('m', 'p', '4', 'v');
  if (!encoder_->part.empty() && encoder_->writer.open(output_.string(), codec, rate_, encoder_->part.size()))
    return;
  const std::filesystem::path film = output_;
  start_series(film.parent_path() / (film.stem().string() + "_frames"));
  notice_ = fmt::format("{}: OpenCV has no codec that can write it; the pictures go to {} as PNGs",
                        film.string(), output_.string());
}

void FilmWriter::add(const cv::Mat& picture) {
  if (encoder_ && pictures_ == 0) open(picture.size());
  if (encoder_) {
    cv::Mat bgr;
    cv::cvtColor(picture(encoder_->part), bgr, cv::COLOR_RGB2BGR);
    encoder_->writer.write(bgr);
  } else {
    write_png(output_ / picture_name(pictures_), picture);
  }
  ++pictures_;
}

void FilmWriter::close() {
  if (!encoder_) {
    // An earlier series may have been longer.
    for (const auto& [number, file] : numbered_files(output_, {}, ".png"))
      if (number >= pictures_) std::filesystem::remove(file);
    return;
  }
  const QuietCodecs quiet;
  encoder_.reset();
  if (pictures_ == 0) return;
  const cv::VideoCapture film(output_.string());
  if (!film.isOpened() || std::lround(film.get(cv::CAP_PROP_FRAME_COUNT)) != pictures_)
    throw InputError(
        output_, fmt::format("does not hold the {} pictures that were filmed; is the disk full?", pictures_));
}

}  // namespace surefield
