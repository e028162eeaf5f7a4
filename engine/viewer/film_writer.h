#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

namespace surefield {

/// Writes pictures one after the other: as a film where the file ends in .mp4 (MPEG-4) or .avi (motion JPEG),
/// as a series of PNGs, 000000.png and so on, where it has no ending and so is a folder. Where no codec can
/// write the film, the pictures become a series in the folder beside it, named as the file without its ending
/// and "_frames". A film can be played after close() only.
class FilmWriter {
 public:
  /// `rate`: pictures a second. Throws InputError where the ending is another or the folder cannot be made.
  FilmWriter(std::filesystem::path file, double rate);
  /// Closes the film; what goes wrong now is not said.
  ~FilmWriter();
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;

  /// Adds a picture (CV_8UC3, RGB), of the size of the first. Codecs want even sizes: in a film, an odd last
  /// row or column is left out. Throws InputError where it cannot be written.
  void add(const cv::Mat& picture);

  /// Completes the film. Throws InputError where it is not whole, as on a full disk.
  void close();

  int pictures() const { return pictures_; }

  /// The file, or the folder, with the pictures.
  const std::filesystem::path& output() const { return output_; }

  /// Why the pictures became a series and no film, as one line for the user; empty where they did not.
  const std::string& notice() const { return notice_; }

 private:
  void open(const cv::Size& size);
  void start_series(const std::filesystem::path& folder);

  struct Encoder;
  std::unique_ptr<Encoder> encoder_;  ///< null: a series
  std::filesystem::path output_;
  double rate_;
  int pictures_ = 0;
  std::string notice_;
};

}  // namespace surefield
