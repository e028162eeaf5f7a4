#include "tests/tools/virtual_screen.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "engine/io/files.h"

namespace surefield::test {

namespace {

std::string output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return "";
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  pclose(pipe);
  return text.substr(0, text.find_last_not_of('\n') + 1);
}

/// A number of an XWD file, which has the highest byte first.
uint32_t number_at(const std::string& file, std::size_t place) {
  uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<uint8_t>(file.at(4 * place + i));
  return number;
}

}  // namespace

bool VirtualScreen::available() {
  return !output_of("command -v Xvfb").empty() && !output_of("command -v xdotool").empty();
}

VirtualScreen::VirtualScreen(const std::filesystem::path& folder, int width, int height)
    : memory_(folder / "Xvfb_screen0") {
  int channel[2];
  if (pipe(channel) != 0) throw std::runtime_error("no pipe to Xvfb");
  const std::string size = std::to_string(width) + "x" + std::to_string(height) + "x24";
  const std::string descriptor = std::to_string(channel[1]);
  server_ = fork();
  if (server_ == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDERR_FILENO);
    execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", size.c_str(), "-fbdir",
           folder.c_str(), "-nocursor", "-nolisten", "tcp", nullptr);
    _exit(127);
  }
  close(channel[1]);
  // The server says its number once it is ready.
  std::string number;
  for (char c = 0; read(channel[0], &c, 1) == 1 && c != '\n';) number += c;
  close(channel[0]);
  if (number.empty()) throw std::runtime_error("Xvfb does not start");
  setenv("DISPLAY", (":" + number).c_str(), 1);
}

VirtualScreen::~VirtualScreen() {
  unsetenv("DISPLAY");
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
}

cv::Mat VirtualScreen::picture() const {
  const std::string file = read_file(memory_);
  // XWDFileHeader: its size, version, format, depth, width, height, ... bytes a line at 12, colours at 19;
  // each of those takes 12 bytes, and then the pixels follow: blue, green, red, nothing.
  const std::size_t begin = number_at(file, 0) + 12 * std::size_t{number_at(file, 19)};
  const int width = static_cast<int>(number_at(file, 4)), height = static_cast<int>(number_at(file, 5));
  const std::size_t stride = number_at(file, 12);
  cv::Mat picture(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        picture.at<cv::Vec3b>(y, x)[c] = static_cast<uint8_t>(file.at(begin + y * stride + 4 * x + 2 - c));
  return picture;
}

std::string VirtualScreen::find_window(const std::string& title) const {
  for (int i = 0; i < 600; ++i) {
    const std::string found = act("search --onlyvisible --name '" + title + "'");
    if (!found.empty()) return found;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  throw std::runtime_error("no window " + title);
}

std::string VirtualScreen::act(const std::string& words) const {
  return output_of("xdotool " + words + " 2>/dev/null");
}

}  // namespace surefield::test
