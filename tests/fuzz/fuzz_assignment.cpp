// Settings on the command line.
#include "engine/config/config.h"
#include "engine/slam/settings.h"
#include "tests/fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  surefield::SlamSettings settings;
  surefield::ConfigSchema schema;
  settings.bind(schema);
  surefield::fuzz::expect_answer([&] { schema.set(std::string(reinterpret_cast<const char*>(data), size)); });
  return 0;
}
