#include "engine/config/config_file.h"

#include <algorithm>
#include <optional>
#include <set>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

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
      if (depth == kDeepestNesting) throw InputError(file_, line, printable(key) + " is nested too deeply");
      if (!seen_.insert(key).second)
        throw InputError(file_, line, printable(key) + " is given twice; remove one");
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

/// A configuration file, on the disk or in the program.
struct Source {
  std::filesystem::path file;     ///< as messages name it
  const std::string* built_in{};  ///< its text; null: on the disk

  bool operator==(const Source& other) const {
    std::error_code ignored;
    if (built_in || other.built_in) return built_in == other.built_in;
    return std::filesystem::equivalent(file, other.file, ignored);
  }
};

/// The built-in file `name`, if there is one.
std::optional<Source> find_built_in(const std::string& name, const BuiltInFiles& files) {
  const auto found = files.find(name);
  if (found == files.end()) return std::nullopt;
  return Source{"built-in " + name, &found->second};
}

/// Where the file that `name` means is, seen from `from`.
Source find_base(const Source& from, const ConfigValue& name, const BuiltInFiles& built_in) {
  if (!name.node.IsScalar()) throw InputError(from.file, name.line, "base must be the name of a file");
  const std::filesystem::path on_disk = from.file.parent_path() / name.node.Scalar();
  if (!from.built_in && file_exists(on_disk)) return {on_disk};
  const auto source = find_built_in(name.node.Scalar(), built_in);
  if (!source) {
    throw InputError(from.file, name.line,
                     printable("the base file " + on_disk.string() + " does not exist"));
  }
  return *source;
}

YAML::Node parse(const Source& source) {
  YAML::Node root;
  try {
    root = YAML::Load(source.built_in ? *source.built_in : read_file(source.file));
  } catch (const YAML::Exception& error) {
    throw InputError(source.file, error.mark.line + 1, "is not valid YAML: " + printable(error.msg));
  }
  if (!root.IsMap() && !root.IsNull()) throw InputError(source.file, "must hold \"key: value\" lines");
  return root;
}

/// `chain` holds the files that are being read, the outermost first.
std::vector<ConfigValue> read_with_base(const Source& source, std::vector<Source> chain,
                                        const BuiltInFiles& built_in) {
  if (std::find(chain.begin(), chain.end(), source) != chain.end()) {
    throw InputError(chain.back().file,
                     "its base leads back to " + source.file.string() + "; remove that line");
  }
  chain.push_back(source);
  Flattener own(source.file);
  own.flatten(parse(source), "", 0);
  std::vector<ConfigValue> values;
  const auto base = std::find_if(own.values.begin(), own.values.end(),
                                 [](const ConfigValue& value) { return value.key == kBaseKey; });
  if (base != own.values.end()) {
    values = read_with_base(find_base(source, *base, built_in), chain, built_in);
  }
  // Only ever copied anew: assigning one YAML::Node to another changes every copy of the former.
  for (const ConfigValue& value : own.values) {
    if (value.key != kBaseKey) values.push_back(value);
  }
  return values;
}

}  // namespace

std::vector<ConfigValue> read_config_file(const std::filesystem::path& file, const BuiltInFiles& built_in) {
  const auto substitute =
      std::filesystem::exists(file) ? std::nullopt : find_built_in(file.string(), built_in);
  return read_with_base(substitute.value_or(Source{file}), {}, built_in);
}

std::vector<ConfigValue> read_built_in_config(const std::string& name, const BuiltInFiles& built_in) {
  return read_with_base(find_built_in(name, built_in).value(), {}, built_in);
}

}  // namespace surefield
