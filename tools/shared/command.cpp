#include "tools/shared/command.h"

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "engine/gpu/error.h"
#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"

namespace surefield {

int exit_code_of_current_exception() {
  try {
    throw;
  } catch (const InputError&) {
    return kWrongInput;
  } catch (const gpu::Error&) {
    return kDeviceError;
  } catch (...) {
    return kFailure;
  }
}

void print_error(const std::string& message) {
  // Not fmt::print(), which throws where nobody reads.
  std::fputs(fmt::format("surefield: error: {}\n", message).c_str(), stderr);
}

std::vector<std::string> known_formats() {
  std::vector<std::string> formats = dataset_formats();
  formats.insert(formats.begin(), "auto");
  return formats;
}

int run_action(const Action& action) {
  try {
    return action();
  } catch (...) {
    print_error(describe_current_exception());
    return exit_code_of_current_exception();
  }
}

}  // namespace surefield
