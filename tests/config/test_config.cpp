#include "engine/config/config.h"

#include "engine/types/error.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

enum class PoseGradient { full, light };

/// Settings with a field of every type, bound to keys.
struct Settings {
  int iterations = 25;
  double rate = 0.0015;
  float opacity = 0.99f;
  bool exposure = false;
  std::string output = "out";
  std::string format = "auto";
  PoseGradient gradient = PoseGradient::full;
  std::vector<double> background = {0, 0, 0};
};

constexpr const char* kDefaults =
    "tracking:\n"
    "  # steps per frame [1 to 10000]\n"
    "  iterations: 25\n"
    "  # learning rate, radians [0 to 1]\n"
    "  rate: 0.0015\n"
    "  mask:\n"
    "    # least opacity [0 to 1]\n"
    "    opacity: 0.99\n"
    "  # terms [full, light]\n"
    "  pose_gradient: \"full\"\n"
    "# folder of the results\n"
    "output: \"out\"\n"
    "mapping:\n"
    "  # estimate exposure\n"
    "  exposure: false\n"
    "  # colour, RGB [0 to 1]\n"
    "  background: [0, 0, 0]\n"
    "dataset:\n"
    "  # layout [auto, tum]\n"
    "  format: \"auto\"\n";

struct Bound {
  Settings settings;
  ConfigSchema schema;

  Bound() {
    schema.add("tracking.iterations", &settings.iterations, Range{1, 10000});
    schema.add("tracking.rate", &settings.rate, Range{0, 1});
    schema.add("output", &settings.output);
    schema.add("tracking.mask.opacity", &settings.opacity, Range{0, 1});
    schema.add("tracking.pose_gradient", &settings.gradient,
               Choices<PoseGradient>{{"full", PoseGradient::full}, {"light", PoseGradient::light}});
    schema.add("mapping.exposure", &settings.exposure);
    schema.add("dataset.format", &settings.format, {"auto", "tum"});
    schema.add("mapping.background", &settings.background, Range{0, 1});
    schema.document(kDefaults);
  }
};

std::string load_error(const std::string& text) {
  const TemporaryFolder folder;
  Bound bound;
  return input_error([&] { bound.schema.load_file(folder.write("c.yaml", text)); });
}

std::string set_error(const std::string& assignment) {
  Bound bound;
  return input_error([&] { bound.schema.set(assignment); });
}

}  // namespace

TEST_CASE("the dump is documented, ordered and grouped, and loads to itself") {
  Bound bound;
  CHECK(bound.schema.dump() == kDefaults);
  bound.settings.output = "a \"b\": #c\\n";
  bound.settings.rate = 1.0 / 3;
  bound.settings.gradient = PoseGradient::light;
  bound.settings.background = {0.1, 0.25, 1};
  const TemporaryFolder folder;
  Bound other;
  other.schema.load_file(folder.write("c.yaml", bound.schema.dump()));
  CHECK(other.schema.dump() == bound.schema.dump());
  CHECK(other.settings.output == bound.settings.output);
  CHECK(other.settings.rate == bound.settings.rate);
  CHECK(other.settings.gradient == PoseGradient::light);
  CHECK(other.settings.background == bound.settings.background);
}

TEST_CASE("files set what they name and leave the rest") {
  const TemporaryFolder folder;
  Bound bound;
  bound.schema.load_file(
      folder.write("c.yaml",
                   "tracking:\n  iterations: 40\n  mask: {opacity: 0.5}\n  pose_gradient: light\n"
                   "mapping:\n  exposure: true\n  background: [1, 0.5, 0]\ndataset:\n"
                   "output: my results\n"));
  CHECK(bound.settings.iterations == 40);
  CHECK(bound.settings.opacity == 0.5f);
  CHECK(bound.settings.gradient == PoseGradient::light);
  CHECK(bound.settings.exposure);
  CHECK(bound.settings.background == std::vector<double>{1, 0.5, 0});
  CHECK(bound.settings.output == "my results");
  CHECK(bound.settings.rate == 0.0015);
  CHECK(load_error("").empty());
  CHECK(load_error("# only a comment\n").empty());
}

TEST_CASE("a base file is read first, relative to the file that names it") {
  const TemporaryFolder folder;
  folder.write("deep/root.yaml", "tracking: {iterations: 1, rate: 0.1}\noutput: root\n");
  folder.write("deep/base.yaml", "output: base\nbase: root.yaml\ntracking:\n  rate: 0.2\n");
  Bound bound;
  bound.schema.load_file(folder.write("c.yaml", "tracking: {rate: 0.3}\nbase: deep/base.yaml\n"));
  CHECK(bound.settings.iterations == 1);
  CHECK(bound.settings.rate == 0.3);
  CHECK(bound.settings.output == "base");
}

TEST_CASE("base files that are missing, wrong or circular are named") {
  CHECK(contains(load_error("output: x\nbase: none.yaml\n"), "c.yaml:2: the base file"));
  CHECK(contains(load_error("base: [1]\n"), "c.yaml:1: base must be the name of a file"));
  CHECK(contains(load_error("base: c.yaml\n"), "its base leads back"));
  const TemporaryFolder folder;
  folder.write("base.yaml", "# one\n# two\nspeed: 3\n");
  Bound bound;
  const auto file = folder.write("c.yaml", "base: base.yaml\n");
  CHECK(contains(input_error([&] { bound.schema.load_file(file); }), "base.yaml:3: unknown key speed"));
}

TEST_CASE("errors name the file, the line, the key and the way out") {
  CHECK(contains(load_error("# a\ntracking:\n  iteration: 3\n"),
                 "c.yaml:3: unknown key tracking.iteration; did you mean tracking.iterations?"));
  CHECK(contains(load_error("ouptut: a\n"), "c.yaml:1: unknown key ouptut; did you mean output?"));
  ConfigSchema camera;
  std::vector<double> values(4);
  for (std::size_t i = 0; const char* key : {"fx", "fy", "cx", "cy"})
    camera.add(key, &values[i++], Range{0, 1});
  CHECK(contains(input_error([&] { camera.set("fY=1"); }), "unknown key fY; did you mean fy?"));
  CHECK(contains(input_error([&] { camera.set("CX=1"); }), "did you mean cx?"));
  CHECK(contains(load_error("tracking:\n  iterations: 0\n"),
                 "c.yaml:2: tracking.iterations must be a whole number from 1 to 10000, not \"0\""));
  CHECK(contains(load_error("output: a\noutput: b\n"), "c.yaml:2: output is given twice"));
  CHECK(contains(load_error("tracking: 5\n"), "c.yaml:1: tracking is a section"));
  CHECK(contains(load_error("output: {a: 1}\n"), "unknown key output.a"));
  CHECK(contains(load_error("tracking:\n  - 1\n"), "tracking is a section"));
  CHECK(contains(load_error("- a\n"), "c.yaml: must hold"));
  CHECK(contains(load_error("a: [1\n"), "is not valid YAML"));
  CHECK(contains(load_error("a: &a\n  b: *a\n"), "nested too deeply"));
  CHECK(contains(load_error("? [1, 2]\n: 3\n"), "a key must be a plain name"));
  Bound bound;
  CHECK(contains(input_error([&] { bound.schema.load_file("no/such.yaml"); }), "no/such.yaml: no such file"));
}

TEST_CASE("values of the wrong type are refused") {
  for (const char* value : {"1.5", "abc", "", "1e3", "[3]", "12x", "99999999999999", "0x10", "true"}) {
    CAPTURE(value);
    CHECK(contains(load_error(std::string("tracking:\n  iterations: ") + value + "\n"),
                   "must be a whole number"));
  }
  for (const char* value : {"nan", ".nan", "inf", "-0.1", "1.0001", "fast"}) {
    CAPTURE(value);
    CHECK(contains(load_error(std::string("tracking:\n  rate: ") + value + "\n"),
                   "must be a number from 0 to 1"));
  }
  CHECK(contains(load_error("mapping: {exposure: 1}\n"), "must be true or false, not \"1\""));
  CHECK(contains(load_error("tracking: {pose_gradient: heavy}\n"),
                 "must be one of full, light, not \"heavy\""));
  CHECK(contains(load_error("dataset: {format: kitti}\n"), "must be one of auto, tum"));
  for (const char* value : {"[1, 0]", "[1, 0, 0, 0]", "[1, 0, x]", "[1, 0, 2]", "1", ""}) {
    CHECK(contains(load_error(std::string("mapping:\n  background: ") + value + "\n"),
                   "must be a list of 3 numbers"));
  }
  CHECK(contains(load_error("output: [a]\n"), "must be text in UTF-8, not a list"));
}

TEST_CASE("configuration files of the program stand in for those that the disk lacks") {
  const TemporaryFolder folder;
  const BuiltInFiles built_in = {{"base.yaml", "tracking: {iterations: 11, rate: 0.5}\n"},
                                 {"fast.yaml", "base: base.yaml\ntracking: {iterations: 3}\n"},
                                 {"circle.yaml", "base: circle.yaml\n"},
                                 {"wrong.yaml", "base: base.yaml\ntracking: {iteration: 3}\n"}};
  {
    Bound bound;
    bound.schema.load_built_in("fast.yaml", built_in);
    CHECK(bound.settings.iterations == 3);
    CHECK(bound.settings.rate == 0.5);
  }
  {
    Bound bound;
    bound.schema.load_file(folder.write("own.yaml", "base: fast.yaml\ntracking: {rate: 0.25}\n"), built_in);
    CHECK(bound.settings.iterations == 3);
    CHECK(bound.settings.rate == 0.25);
  }
  {
    Bound bound;
    folder.write("fast.yaml", "tracking: {iterations: 5}\n");
    bound.schema.load_file(folder / "own.yaml", built_in);
    CHECK(bound.settings.iterations == 5);
    bound.schema.load_file("fast.yaml", built_in);
    CHECK(bound.settings.iterations == 3);
  }
  {
    Bound bound;
    bound.schema.load_file(folder.write("many.yaml",
                                        "base: base.yaml\ntracking: {iterations: 3, rate: 0.25, mask: "
                                        "{opacity: 0.75}}\noutput: there\n"),
                           built_in);
    CHECK(bound.settings.iterations == 3);
    CHECK(bound.settings.rate == 0.25);
    CHECK(bound.settings.opacity == 0.75f);
    CHECK(bound.settings.output == "there");
  }
  Bound bound;
  CHECK(contains(input_error([&] { bound.schema.load_built_in("circle.yaml", built_in); }), "leads back to"));
  CHECK(contains(input_error([&] { bound.schema.load_built_in("wrong.yaml", built_in); }),
                 "built-in wrong.yaml:2: unknown key tracking.iteration"));
  CHECK(contains(input_error([&] { bound.schema.load_file("no.yaml", built_in); }), "no such file"));
}

TEST_CASE("single values are set as on a command line") {
  Bound bound;
  bound.schema.set("tracking.iterations=7");
  bound.schema.set("mapping.background=[0, 1, 0.5]");
  bound.schema.set("output=/a: b=[c");
  bound.schema.set("tracking.pose_gradient=light");
  CHECK(bound.settings.iterations == 7);
  CHECK(bound.settings.background == std::vector<double>{0, 1, 0.5});
  CHECK(bound.settings.output == "/a: b=[c");
  CHECK(bound.settings.gradient == PoseGradient::light);
  CHECK(contains(set_error("tracking.iterations"), "expected key=value"));
  CHECK(contains(set_error("=3"), "expected key=value"));
  CHECK(
      contains(set_error("tracking.iterations=x"), "\"tracking.iterations=x\": tracking.iterations must be"));
  CHECK(contains(set_error("trackin.rate=1"), "did you mean tracking.rate?"));
  CHECK(contains(set_error("mapping.background=[1, 2"), "must be a list of 3 numbers"));
}

TEST_CASE("a number tells its range, its help and its value") {
  int steps = 3;
  double rate = 0.5;
  bool flag = true;
  ConfigSchema schema;
  schema.add("steps", &steps, Range{1, 9});
  schema.add("part.rate", &rate, Range{0, 2});
  schema.add("flag", &flag);
  CHECK(schema.number("part.rate").help == "");
  schema.document(
      "# how many [1 to 9]\nsteps: 3\npart:\n  # how fast [0 to 2]\n  rate: 0\n# whether\nflag: true\n");
  schema.set("part.rate=1.5");
  const NumberSetting number = schema.number("part.rate");
  CHECK(number.value == 1.5);
  CHECK(number.range.max == 2);
  CHECK(number.help == "how fast");
  CHECK_FALSE(number.whole);
  CHECK(schema.number("steps").whole);
  CHECK_THROWS_AS(schema.number("flag"), UsageError);
  CHECK_THROWS_AS(schema.number("none"), UsageError);
}

TEST_CASE("every key must be documented, with the values that it permits") {
  int steps = 3;
  bool flag = true;
  ConfigSchema schema;
  schema.add("part.steps", &steps, Range{1, 9});
  schema.add("flag", &flag);
  const std::string good = "part:\n  # how many [1 to 9]\n  steps: 1\n# whether\nflag: true\n";
  CHECK_NOTHROW(schema.document(good));
  CHECK(schema.number("part.steps").help == "how many");
  CHECK(steps == 3);  // documentation sets nothing
  for (const auto& [part, changed] : {std::pair{"  # how many [1 to 9]\n", ""},
                                      {"[1 to 9]", "[1 to 8]"},
                                      {" [1 to 9]", ""},
                                      {"how many", ""},
                                      {"how many ", ""},
                                      {"  steps: 1\n", ""},
                                      {"# whether\n", "\n"},
                                      {"flag: true\n", ""}}) {
    std::string text = good;
    text.replace(text.find(part), std::string(part).size(), changed);
    CAPTURE(text);
    CHECK_THROWS_AS(schema.document(text), UsageError);
  }
}

TEST_CASE("a key that has been renamed leads to its name, in a file and on a command line") {
  Bound bound;
  bound.schema.renamed("steps", "tracking.iterations");
  bound.schema.renamed("tracking.colour", "mapping.background");
  CHECK(contains(input_error([&] { bound.schema.set("steps=3"); }),
                 "the key steps has been renamed; use tracking.iterations"));
  const TemporaryFolder folder;
  const auto file = folder.write("c.yaml", "output: a\ntracking:\n  colour: [0, 1, 0]\n");
  CHECK(contains(input_error([&] { bound.schema.load_file(file); }),
                 "c.yaml:3: the key tracking.colour has been renamed; use mapping.background"));
  CHECK_THROWS_AS(bound.schema.renamed("steps", "none"), UsageError);
  CHECK_THROWS_AS(bound.schema.renamed("output", "tracking.iterations"), UsageError);
}

TEST_CASE("mistakes of the programmer are caught when a key is added") {
  ConfigSchema schema;
  int value = 1;
  std::string name = "other";
  schema.add("a.b", &value, Range{0, 1});
  CHECK_THROWS_AS(schema.add("a.b", &value, Range{0, 1}), UsageError);
  CHECK_THROWS_AS(schema.add("a", &value, Range{0, 1}), UsageError);
  CHECK_THROWS_AS(schema.add("a.b.c", &value, Range{0, 1}), UsageError);
  CHECK_THROWS_AS(schema.add("name", &name, {"one", "two"}), UsageError);
}
