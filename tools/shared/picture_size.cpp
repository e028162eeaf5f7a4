#include "tools/shared/picture_size.h"

#include <cstdio>

namespace surefield {

namespace {

constexpr int kSmallestPicture = 16, kLargestPicture = 8192;  // pixels

bool read_size(const std::string& text, PictureSize& size) {
  int read = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &size.width, &size.height, &read) != 2) return false;
  const auto fits = [](int side) { return side >= kSmallestPicture && side <= kLargestPicture; };
  return read == static_cast<int>(text.size()) && fits(size.width) && fits(size.height);
}

}  // namespace

CLI::Option* add_size_option(CLI::App& command, const std::string& name, PictureSize& size,
                             const std::string& help) {
  return command
      .add_option_function<std::string>(
          name,
          [&size, name](const std::string& text) {
            if (!read_size(text, size))
              throw CLI::ValidationError(
                  name + " " + text + " is no size such as 1280x720, with sides from " +
                  std::to_string(kSmallestPicture) + " to " + std::to_string(kLargestPicture));
          },
          help)
      ->type_name("WxH");
}

}  // namespace surefield
