// The commands `vocabulary` and `places`.
#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

TEST_CASE("a vocabulary is made of a recording, the same each time, and places are looked up with it") {
  const TemporaryFolder folder;
  const std::string walk = folder / "walk";
  REQUIRE(surefield_command({"synth", "--frames", "5", "--size", "160x120", "--path", "robot", "--out", walk},
                            folder.path())
              .code == 0);
  const auto make = [&](const std::string& name, const std::string& words) {
    return surefield_command({"vocabulary", "--dataset", walk, "--dataset", walk, "--every", "2", "--words",
                              words, "--out", folder / name},
                             folder.path());
  };
  const Outcome outcome = make("words.txt", "4");
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "4 words of"));
  CHECK(read_lines(folder / "words.txt").size() == 4);
  make("again.txt", "4");
  CHECK(read_file(folder / "again.txt") == read_file(folder / "words.txt"));
  CHECK(make("many.txt", "4096").code == 2);

  const auto look_up = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"places", "--dataset", walk, "--every", "1"});
    return surefield_command(more, folder.path());
  };
  const Outcome places = look_up({});
  REQUIRE_MESSAGE(places.code == 0, places.err);
  CHECK(contains(places.out, "5 keyframes, of which 3 see what one at least 2 before saw"));
  CHECK(contains(places.out, "VLAD over RootSIFT               100.0 %"));
  CHECK(contains(places.out, "most recent                      100.0 %"));
  // Words of these very frames are the means of their features, which then differ from them by little.
  const Outcome own = look_up({"--vocabulary", folder / "words.txt"});
  CHECK(own.code == 0);
  CHECK(own.out != places.out);
}

TEST_CASE("vocabulary and places name what is wrong") {
  const TemporaryFolder folder;
  const std::string none = folder / "none";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"vocabulary", "--dataset", none, "--out", folder / "words.txt"},
        {"places", "--dataset", none},
        {"places", "--dataset", folder.path().string(), "--vocabulary", none}}) {
    const Outcome outcome = surefield_command(arguments, folder.path());
    CHECK(outcome.code == 2);
    CHECK_MESSAGE(contains(outcome.err, "none"), outcome.err);
  }
}
