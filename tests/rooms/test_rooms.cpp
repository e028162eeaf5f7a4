// The rooms of engine/: dependencies run one way, and the tower of data stands without Vulkan.
#include <doctest/doctest.h>

#include <filesystem>
#include <regex>

#include "engine/io/files.h"
#include "rooms.h"

namespace surefield::test {

namespace {

namespace fs = std::filesystem;

const fs::path kEngine = SUREFIELD_SOURCE_DIR "/engine";

/// The folders of a source file's own include lines: "engine/io", "shaders/shared", "tools/run", ...
std::vector<std::string> included_folders(const fs::path& file) {
  static const std::regex line(R"re(#include "([a-z_/]+)/[a-z_0-9.]+")re");
  const std::string text = read_file(file);
  std::vector<std::string> folders;
  for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it)
    folders.push_back((*it)[1]);
  return folders;
}

bool is_source(const fs::path& file) {
  return file.extension() == ".h" || file.extension() == ".cpp" || file.extension() == ".in";
}

/// A room and all that it rests on, directly or not.
std::set<std::string> closure(const std::string& room) {
  std::set<std::string> rooms = {room};
  for (const std::string& below : kRooms.at(room))
    if (!below.empty()) rooms.merge(closure(below));
  return rooms;
}

}  // namespace

TEST_CASE("every folder of engine/ is a room") {
  for (const auto& entry : fs::directory_iterator(kEngine)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory() || name == "cmake") continue;
    INFO(name);
    CHECK(kRooms.contains(name));
  }
}

TEST_CASE("no include runs upward") {
  int includes = 0;
  for (const auto& [room, below] : kRooms) {
    for (const auto& entry : fs::directory_iterator(kEngine / room)) {
      if (!is_source(entry.path())) continue;
      for (const std::string& folder : included_folders(entry.path())) {
        const auto slash = folder.find('/');
        const std::string top = folder.substr(0, slash), name = folder.substr(slash + 1);
        INFO(entry.path().string(), " includes from ", folder);
        if (top == "shaders") {
          CHECK(closure(room).contains("gpu"));
        } else {
          CHECK(top == "engine");
          CHECK((name == room || closure(room).contains(name)));
        }
        ++includes;
      }
    }
  }
  CHECK(includes > 500);
}

TEST_CASE("files, formats, logs, sources, evaluation, meshes and reports need no Vulkan") {
  for (const char* room :
       {"types", "io", "config", "formats", "logs", "sources", "places", "graph", "mesh", "eval", "report"}) {
    INFO(room);
    CHECK_FALSE(closure(room).contains("gpu"));
  }
}

}  // namespace surefield::test
