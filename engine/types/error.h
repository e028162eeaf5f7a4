#pragma once

#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace surefield {

/// What all exceptions of this library derive from, those of the standard library apart (std::bad_alloc). The
/// message is one clear line that names the thing and the way out.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Something the user gave is missing, corrupt or wrong: a file, a folder, a key, a value. The message is one
/// clear line that names the thing and says what to do about it; a program prints it and exits with a
/// non-zero code.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(message) {}

  /// "file: problem"
  InputError(const std::filesystem::path& file, const std::string& problem)
      : Error(file.string() + ": " + problem) {}

  /// "file:line: problem"; `line` counts from 1.
  InputError(const std::filesystem::path& file, int line, const std::string& problem)
      : Error(file.string() + ":" + std::to_string(line) + ": " + problem) {}
};

/// A frame whose image cannot be used, though it is read without fault: one that shows nothing, or not yet
/// the light that the camera will see by. The next one may do.
class NoImageError : public InputError {
 public:
  using InputError::InputError;
};

/// A call that its contract forbids: the caller's mistake, not the user's. Nothing has changed.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// A call that came too late: the object has ended or is broken, and the message says by what.
class StateError : public UsageError {
 public:
  using UsageError::UsageError;
};

/// A failure of the Vulkan device or its driver.
class DeviceError : public Error {
 public:
  enum class Kind { NoDevice, MissingFeature, OutOfMemory, DeviceLost, Limit, Driver };

  DeviceError(Kind kind, const std::string& message) : Error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// The exception that is being handled as one line: what happened and what to do about it.
std::string describe_current_exception();
/// The same of an exception that was kept.
std::string describe(const std::exception_ptr& error);

}  // namespace surefield
