// The configurations that the program carries inside it.
#include <sstream>

#include "engine/config/built_in_configs.h"
#include "engine/io/files.h"
#include "engine/slam/settings.h"
#include "tests/support/input_files.h"
#include "tools/results/run_configuration.h"

using namespace surefield;

TEST_CASE("base.yaml documents exactly the keys of the program with their defaults") {
  const std::string file = read_file(SUREFIELD_SOURCE_DIR "/configs/base.yaml");
  CHECK(built_in_configs().at("base.yaml") == file);
  SlamSettings settings;
  ConfigSchema schema;
  settings.bind(schema);
  // After the heading, which ends with an empty line, the file is what the program itself writes to
  // config.yaml.
  std::istringstream written(file.substr(file.find("\n\n") + 2)), expected(schema.dump());
  std::string written_line, expected_line;
  while (std::getline(expected, expected_line)) {
    std::getline(written, written_line);
    INFO("configs/base.yaml must hold the keys in the order of SlamSettings::bind(), with their defaults");
    REQUIRE(written_line == expected_line);
  }
  CHECK_FALSE(std::getline(written, written_line));
}

TEST_CASE("every built-in configuration can be read and names only what differs from its base") {
  for (const auto& entry : built_in_configs()) {
    const std::string& name = entry.first;
    CAPTURE(name);
    SlamSettings settings;
    ConfigSchema schema;
    settings.bind(schema);
    const std::string defaults = schema.dump();
    CHECK_NOTHROW(schema.load_built_in(name, built_in_configs()));
    if (name == "replica.yaml") CHECK(schema.dump() != defaults);
  }
}

TEST_CASE("keys that apply to one method of tracking lead from their old names to its section") {
  SlamSettings settings;
  ConfigSchema schema;
  settings.bind(schema);
  for (const auto& renamed : {std::pair{"first_tracking_iterations", "adam.first_iterations"},
                              {"tracking.iterations", "adam.iterations"},
                              {"tracking.stop_below", "adam.stop_below"},
                              {"tracking.renders", "gauss_newton.renders"},
                              {"tracking.reference_weight", "gauss_newton.reference_weight"}}) {
    const std::string old = renamed.first, key = renamed.second;
    CAPTURE(old);
    const std::string assignment = std::string(old) + "=1";
    CHECK(test::contains(test::input_error([&] { schema.set(assignment); }),
                         std::string("has been renamed; use ") + key));
    CHECK_NOTHROW(schema.set(std::string(key) + "=1"));
  }
  CHECK(test::contains(test::input_error([&] { schema.set("mapping.rate_mean=0.0003"); }),
                       std::string("use mapping.rate_centre, which is in pixels")));
}

TEST_CASE("a run takes the configuration of its format, then the user's values") {
  const auto effective = [](RunOptions options, const std::string& format) {
    SlamSettings settings;
    load_settings(settings, options, format);
    return settings;
  };
  CHECK(effective({}, "replica").keyframes.interval == 10);
  CHECK(effective({}, "replica").tracking.adam.iterations == 15);
  CHECK(effective({}, "tum").tracking.adam.iterations == 35);
  CHECK(effective({}, "unheard of").tracking.adam.iterations == 35);
  CHECK(effective({.config = "replica.yaml"}, "tum").keyframes.interval == 10);
  const SlamSettings own = effective({.assignments = {"adam.iterations=7", "seed=5"}}, "replica");
  CHECK(own.tracking.adam.iterations == 7);
  CHECK(own.seed == 5);
  CHECK(own.keyframes.interval == 10);
}
