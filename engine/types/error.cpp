#include "engine/types/error.h"

#include <exception>
#include <new>

namespace surefield {

std::string describe_current_exception() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return "out of memory; close other programs, or use fewer frames or a smaller --scale";
  } catch (const std::exception& error) {
    std::string message = error.what();
    for (char& c : message) c = c == '\n' ? ' ' : c;
    return message;
  } catch (...) {
    return "an unknown error";
  }
}

std::string describe(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (...) {
    return describe_current_exception();
  }
}

}  // namespace surefield
