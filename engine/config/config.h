#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace YAML {
class Node;
}

namespace surefield {

struct ConfigValue;

/// Smallest and largest permitted value of a number, both included.
struct Range {
  double min = 0;
  double max = 0;
};

/// The names of the values of an enumeration (or of any type), in the order in which they are listed to the
/// user.
template <typename T>
using Choices = std::vector<std::pair<std::string, T>>;

/// Configuration files that the program carries inside it: text by name.
using BuiltInFiles = std::map<std::string, std::string>;

/// A number that can be set, as it is now.
struct NumberSetting {
  std::string key;
  std::string help;  ///< one line: meaning and unit
  Range range;
  bool whole = false;  ///< a whole number
  double value = 0;
};

/// Typed configuration: modules bind dotted keys to the fields of their settings, and the user's values are
/// checked before they are stored. What a field holds when it is added is its default.
///
///   TrackingSettings tracking;
///   ConfigSchema schema;
///   schema.add("adam.iterations", &tracking.adam.iterations, Range{1, 10000});
///   schema.add("adam.pose_gradient", &tracking.adam.pose_gradient,
///              Choices<PoseGradientKind>{{"full", PoseGradientKind::Full}, {"light",
///              PoseGradientKind::Light}});
///   schema.load_file("configs/tum.yaml");
///   schema.set("adam.iterations=40");
///
/// The fields must outlive the schema and keep their addresses.
class ConfigSchema {
 public:
  void add(const std::string& key, int* value, Range range);
  void add(const std::string& key, float* value, Range range);
  void add(const std::string& key, double* value, Range range);
  void add(const std::string& key, bool* value);
  void add(const std::string& key, std::string* value);

  /// A list of exactly as many numbers as `value` holds now, each within `range`.
  void add(const std::string& key, std::vector<double>* value, Range range);

  /// A list of one of those numbers of numbers.
  void add(const std::string& key, std::vector<double>* value, Range range, std::vector<std::size_t> sizes);

  /// A string out of a list of names.
  void add(const std::string& key, std::string* value, const std::vector<std::string>& names);

  /// An enumeration, given by name. The field must hold one of the listed values.
  template <typename T>
  void add(const std::string& key, T* value, const Choices<T>& choices);

  /// Takes the help of all keys that have been added from the text of a configuration file: of each key the
  /// comment in the line above it, which says its meaning and unit, and ends with the permitted values in
  /// brackets where there are any but true and false. Throws UsageError naming the key of which the
  /// text has no such comment.
  void document(const std::string& text);

  /// Tells whoever gives the key `old` that its name is `key`, which has been added, and where its unit is
  /// another one too, which. Throws UsageError where it has not been added, or where `old` is a key.
  void renamed(const std::string& old, const std::string& key, const std::string& unit = {});

  /// Reads a YAML file; nested maps are dotted keys. A top-level key `base` names a file, relative to this
  /// one, that is read first. Throws InputError with file, line and key for an unknown key (with its
  /// name where it was renamed, else the nearest known one), a key given twice, and a value of the wrong type
  /// or out of range; fields read before it keep their new values. Where the disk has no `file`, or no base
  /// file of that name, the one in `built_in` is read.
  void load_file(const std::filesystem::path& file, const BuiltInFiles& built_in = {});

  /// Reads the file `name` of `built_in`, whatever the disk holds; it must be there.
  void load_built_in(const std::string& name, const BuiltInFiles& built_in);

  /// Sets one value from "key=value", as given on a command line; lists are written [1, 2, 3]. Throws
  /// InputError.
  void set(const std::string& assignment);

  /// The number of this key. Throws UsageError where no number has it.
  NumberSetting number(const std::string& key) const;

  /// The effective configuration as YAML that load_file accepts: every key in the order in which it was added
  /// (grouped by section), each below its help as in document(), where it has been given.
  std::string dump() const;

 private:
  /// Stores a value; returns what was expected instead where it cannot, else an empty string.
  using Parser = std::function<std::string(const YAML::Node&)>;

  struct Entry {
    std::string key;
    std::string permitted;  ///< values, in brackets with a space before; empty: the type says which
    bool is_list = false;   ///< given as a YAML list, also on the command line
    Parser parse;
    std::function<std::string()> print;               ///< the current value as YAML
    std::function<NumberSetting()> number = nullptr;  ///< where it is one, without its help
    std::string help = {};
  };

  void add_entry(Entry entry);
  template <typename T>
  void add_number(const std::string& key, T* value, Range range, const char* kind);
  void add_choice(const std::string& key, const std::vector<std::string>& names,
                  std::function<void(std::size_t)> store, std::function<std::size_t()> load);
  const Entry* find(const std::string& key) const;
  bool is_section(const std::string& key) const;
  /// Stores the values of a file in their order.
  void apply_all(const std::vector<ConfigValue>& values) const;
  /// Stores a value, or returns what is wrong with it.
  std::string apply(const std::string& key, const YAML::Node& value) const;
  /// The keys that start with `prefix` (empty, or ending in a dot) as indented YAML.
  std::string dump_section(const std::string& prefix, std::size_t depth) const;

  std::vector<Entry> entries_;
  std::map<std::string, std::string> renamed_;  ///< by the old name
};

template <typename T>
void ConfigSchema::add(const std::string& key, T* value, const Choices<T>& choices) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  auto store = [value, choices](std::size_t i) { *value = choices[i].second; };
  auto load = [value, choices] {
    std::size_t i = 0;
    while (i < choices.size() && choices[i].second != *value) ++i;
    return i;
  };
  add_choice(key, names, store, load);
}

}  // namespace surefield
