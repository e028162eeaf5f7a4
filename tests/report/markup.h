#pragma once

#include <set>
#include <string>
#include <vector>

namespace surefield::test {

/// What is wrong with the nesting of HTML or SVG elements; empty where each one that is opened is closed in
/// its turn. Elements that hold nothing need no end.
inline std::string nesting_problem(const std::string& html) {
  static const std::set<std::string> kVoid = {"meta", "img", "br", "link", "!DOCTYPE"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return "a tag without end";
    const std::string tag = html.substr(at + 1, end - at - 1);
    const bool closes = tag.front() == '/';
    const std::string name = tag.substr(closes ? 1 : 0, tag.find_first_of(" \n/", 1) - (closes ? 1 : 0));
    if (closes) {
      const std::string last = open.empty() ? "nothing" : open.back();
      if (last != name) return "</" + name + "> closes " + last;
      open.pop_back();
    } else if (!kVoid.contains(name) && tag.back() != '/') {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : open.back() + " stays open";
}

}  // namespace surefield::test
