// Settings: what was read must come back from what is printed.
#include "engine/config/config.h"
#include "engine/slam/settings.h"
#include "tests/fuzz/harness.h"

namespace {

void read(const std::filesystem::path& file) {
  surefield::SlamSettings settings;
  surefield::ConfigSchema schema;
  settings.bind(schema);
  schema.load_file(file);
  const std::string dumped = schema.dump();
  const auto again = surefield::fuzz::write_input(
      "dumped.yaml", reinterpret_cast<const uint8_t*>(dumped.data()), dumped.size());
  schema.load_file(again);
  if (schema.dump() != dumped) __builtin_trap();
}

}  // namespace

SUREFIELD_FUZZ_FILE("config.yaml", read)
