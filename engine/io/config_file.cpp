#include "engine/io/config_file.h"

#include <algorithm>
#include <set>

#include "engine/io/error.h"
#include "engine/io/files.h"

namespace surefield {

namespace {

constexpr const char* kBaseKey = "base";
constexpr int kDeepestNesting = 16;  // an alias that contains itself would nest for ever

/// Flattens the maps of one file.
class Flattener {
 public:
  explicit Flattener(const std::filesystem::path& file) : file_(file) {}

  void flatten(const YAML::Node& map, const std::string& prefix, int depth) {
    for (const auto& item : map) {
      const int line = item.first.Mark().line + 1;
      if (!item.first.IsScalar()) throw InputError(file_, line, "a key must be a plain name");
      const std::string key = prefix + item.first.Scalar();
      if (depth == kDeepestNesting) throw InputError(file_, line, key + " is nested too deeply");
      if (!seen_.insert(key).second) throw InputError(file_, line, key + " is given twice; remove one");
      if (item.second.IsMap()) {
        flatten(item.second, key + ".", depth + 1);
      } else {
        values.push_back({key, item.second, file_, line});
      }
    }
  }

  std::vector<ConfigValue> values;

 private:
  const std::filesystem::path& file_;
  std::set<std::string> seen_;
};

YAML::Node parse_file(const std::filesystem::path& file) {
  YAML::Node root;
  try {
    root = YAML::Load(read_file(file));
  } catch (const YAML::Exception& error) {
    throw InputError(file, error.mark.line + 1, "is not valid YAML: " + error.msg);
  }
  if (!root.IsMap() && !root.IsNull()) throw InputError(file, "must hold \"key: value\" lines");
  return root;
}

/// `chain` holds the files that are being read, the outermost first.
std::vector<ConfigValue> read_with_base(const std::filesystem::path& file,
                                        std::vector<std::filesystem::path> chain) {
  const auto same_file = [&](const std::filesystem::path& other) {
    std::error_code ignored;
    return std::filesystem::equivalent(file, other, ignored);
  };
  if (std::any_of(chain.begin(), chain.end(), same_file)) {
    throw InputError(chain.back(), "its base leads back to " + file.string() + "; remove that line");
  }
  chain.push_back(file);
  Flattener own(file);
  own.flatten(parse_file(file), "", 0);
  std::vector<ConfigValue> values;
  const auto base = std::find_if(own.values.begin(), own.values.end(),
                                 [](const ConfigValue& value) { return value.key == kBaseKey; });
  if (base != own.values.end()) {
    if (!base->node.IsScalar()) throw InputError(file, base->line, "base must be the name of a file");
    const std::filesystem::path base_file = file.parent_path() / base->node.Scalar();
    if (!std::filesystem::exists(base_file)) {
      throw InputError(file, base->line, "the base file " + base_file.string() + " does not exist");
    }
    values = read_with_base(base_file, chain);
    own.values.erase(base);
  }
  values.insert(values.end(), own.values.begin(), own.values.end());
  return values;
}

}  // namespace

std::vector<ConfigValue> read_config_file(const std::filesystem::path& file) {
  return read_with_base(file, {});
}

}  // namespace surefield
