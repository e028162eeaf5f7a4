#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace surefield {

/// Writes text to stdout or stderr. Where nobody reads it any more the user wants no more of the program:
/// that does what a first Ctrl-C does, and nothing is thrown. For `surefield run`, which has something to
/// save.
void say_text(std::FILE* to, const std::string& text);

/// The same, with the text as of fmt::format().
template <typename... Arguments>
void say(std::FILE* to, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  say_text(to, fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace surefield
