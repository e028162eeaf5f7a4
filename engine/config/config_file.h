#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>
#include <vector>

#include "engine/config/config.h"

namespace surefield {

/// One value of a configuration file.
struct ConfigValue {
  std::string key;  ///< dotted: the keys of all enclosing maps and its own
  YAML::Node node;
  std::filesystem::path file;
  int line = 0;  ///< of the key, from 1
};

/// The values of a YAML file in their order, those of its base file first. Where the disk has no `file`, or
/// no base file of that name, the one in `built_in` is read. Throws InputError for a file that cannot be read
/// or is no YAML map, for a key given twice, and for base files that name each other in a circle.
std::vector<ConfigValue> read_config_file(const std::filesystem::path& file, const BuiltInFiles& built_in);

/// The same for the file `name` of `built_in`, which must be there; its base files are built in too.
std::vector<ConfigValue> read_built_in_config(const std::string& name, const BuiltInFiles& built_in);

}  // namespace surefield
