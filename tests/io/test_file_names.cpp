#include "engine/io/file_names.h"

#include <algorithm>
#include <vector>

#include "engine/io/files.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::TemporaryFolder;

TEST_CASE("names are sorted as people sort them") {
  const std::vector<std::string> sorted = {"",
                                           "0",
                                           "1",
                                           "2",
                                           "010",
                                           "10",
                                           "a",
                                           "a1",
                                           "a2b",
                                           "a10",
                                           "a10b",
                                           "b1",
                                           "b99999999999999999999",
                                           "b100000000000000000000"};
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t j = 0; j < sorted.size(); ++j) {
      CAPTURE(sorted[i]);
      CAPTURE(sorted[j]);
      CHECK(natural_less(sorted[i], sorted[j]) == (i < j));
    }
}

TEST_CASE("images are found by number, however it is spelt") {
  const TemporaryFolder folder;
  for (const char* name :
       {"f000.png", "f1.JPG", "f0002.jpeg", "f3.txt", "f4", ".f5.png", "g6.png", "f.png", "f99999999999.png"})
    folder.write(name, "");
  const auto images = numbered_images(folder.path(), {"f"});
  REQUIRE(images.size() == 3);
  CHECK(images.at(1).filename() == "f1.JPG");
  CHECK(images.at(2).filename() == "f0002.jpeg");
  CHECK(numbered_files(folder.path(), {"f"}, ".txt").size() == 1);
  CHECK(numbered_images(folder / "nowhere", {"f"}).empty());
}

TEST_CASE("a name means the file of another spelling, where there is only one") {
  const TemporaryFolder folder;
  folder.write("rgb/0007.PNG", "");
  folder.write("rgb/8.jpg", "");
  folder.write("rgb/Frame-09.png", "");
  const auto found = [&](const std::string& name) {
    return find_spelling(folder / name).filename().string();
  };
  CHECK(found("rgb/8.jpg") == "8.jpg");
  CHECK(found("rgb/8.png") == "8.jpg");
  CHECK(found("rgb/7.png") == "0007.PNG");
  CHECK(found("rgb\\8.jpg") == "8.jpg");
  CHECK(found("rgb/frame-9.jpeg") == "Frame-09.png");
  CHECK(found("rgb/70.png") == "70.png");
  folder.write("rgb/08.png", "");
  CHECK(found("rgb/008.png") == "008.png");
}
