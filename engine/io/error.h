#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace surefield {

/// Something the user gave is missing, corrupt or wrong: a file, a folder, a key, a value. The message is one
/// clear line that names the thing and says what to do about it; a program prints it and exits with a
/// non-zero code.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}

  /// "file: problem"
  InputError(const std::filesystem::path& file, const std::string& problem)
      : std::runtime_error(file.string() + ": " + problem) {}

  /// "file:line: problem"; `line` counts from 1.
  InputError(const std::filesystem::path& file, int line, const std::string& problem)
      : std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + problem) {}
};

}  // namespace surefield
