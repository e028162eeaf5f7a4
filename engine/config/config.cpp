#include "engine/config/config.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <sstream>
#include <string_view>

#include "engine/config/config_file.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

/// The value as it stands in the file, for messages.
std::string quote(const YAML::Node& node) {
  if (node.IsNull()) return "nothing";
  if (node.IsScalar()) return "\"" + node.Scalar() + "\"";
  return node.IsMap() ? "a section" : "a list";
}

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  return text;
}

/// Number of insertions, deletions and replacements of characters that turn `a` into `b` (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::vector<std::string> split_lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// What the comment above a line, counted from 1, says before its end, which must be `permitted`; empty where
/// there is no such comment.
std::string help_above(const std::vector<std::string>& lines, int line, const std::string& permitted) {
  if (line < 2) return {};
  std::string comment = lines.at(static_cast<std::size_t>(line) - 2);
  comment.erase(0, comment.find_first_not_of(' '));
  if (!comment.starts_with("# ")) return {};
  const std::string help = comment.substr(2);
  return help.ends_with(permitted) ? help.substr(0, help.size() - permitted.size()) : "";
}

}  // namespace

void ConfigSchema::add_entry(Entry entry) {
  bool taken = find(entry.key) || is_section(entry.key);
  for (auto dot = entry.key.find('.'); dot != std::string::npos; dot = entry.key.find('.', dot + 1)) {
    taken = taken || find(entry.key.substr(0, dot));
  }
  if (taken) throw UsageError("the key " + entry.key + " is added twice, or is a section and a value");
  entries_.push_back(std::move(entry));
}

const ConfigSchema::Entry* ConfigSchema::find(const std::string& key) const {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.key == key; });
  return found == entries_.end() ? nullptr : &*found;
}

NumberSetting ConfigSchema::number(const std::string& key) const {
  const Entry* entry = find(key);
  if (!entry || !entry->number) throw UsageError("there is no number " + key);
  NumberSetting setting = entry->number();
  setting.help = entry->help;
  return setting;
}

void ConfigSchema::document(const std::string& text) {
  const std::vector<std::string> lines = split_lines(text);
  const std::string name = "documentation";
  const std::vector<ConfigValue> values = read_built_in_config(name, {{name, text}});
  for (Entry& entry : entries_) {
    const auto value = std::find_if(values.begin(), values.end(),
                                    [&](const ConfigValue& candidate) { return candidate.key == entry.key; });
    entry.help = value == values.end() ? "" : help_above(lines, value->line, entry.permitted);
    if (entry.help.empty())
      throw UsageError("the key " + entry.key + " must stand below a comment that ends with \"" +
                       entry.permitted + "\"");
  }
}

void ConfigSchema::renamed(const std::string& old, const std::string& key, const std::string& unit) {
  if (find(old) || !find(key)) throw UsageError(old + " cannot be an old name of " + key);
  renamed_[old] = unit.empty() ? key : key + ", which is " + unit;
}

bool ConfigSchema::is_section(const std::string& key) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& entry) { return entry.key.starts_with(key + "."); });
}

std::string ConfigSchema::apply(const std::string& key, const YAML::Node& value) const {
  if (const Entry* entry = find(key)) {
    const std::string expected = entry->parse(value);
    return expected.empty() ? expected : fmt::format("{} must be {}, not {}", key, expected, quote(value));
  }
  if (is_section(key)) {
    // "tracking:" with nothing below it sets nothing.
    return value.IsNull() ? "" : fmt::format("{} is a section, not a value; its keys go below it", key);
  }
  if (const auto found = renamed_.find(key); found != renamed_.end())
    return fmt::format("the key {} has been renamed; use {}", key, found->second);
  if (entries_.empty()) return "unknown key " + key;
  // A letter's case is the least that may be wrong: fY is fy and not fx.
  const auto distance = [name = lower_case(key)](const Entry& entry) {
    return edit_distance(name, lower_case(entry.key));
  };
  const auto nearest =
      std::min_element(entries_.begin(), entries_.end(),
                       [&](const Entry& a, const Entry& b) { return distance(a) < distance(b); });
  return fmt::format("unknown key {}; did you mean {}?", key, nearest->key);
}

void ConfigSchema::load_file(const std::filesystem::path& file, const BuiltInFiles& built_in) {
  apply_all(read_config_file(file, built_in));
}

void ConfigSchema::load_built_in(const std::string& name, const BuiltInFiles& built_in) {
  apply_all(read_built_in_config(name, built_in));
}

void ConfigSchema::apply_all(const std::vector<ConfigValue>& values) const {
  for (const ConfigValue& value : values) {
    const std::string problem = apply(value.key, value.node);
    if (!problem.empty()) throw InputError(value.file, value.line, printable(problem));
  }
}

void ConfigSchema::set(const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("\"" + printable(assignment) +
                     "\": expected key=value, for example mapping_iterations=40");
  }
  const std::string key = assignment.substr(0, equals);
  const std::string text = assignment.substr(equals + 1);
  const Entry* entry = find(key);
  // Only lists are YAML here: a path or a name may hold characters that mean something to YAML.
  YAML::Node value(text);
  try {
    if (entry && entry->is_list) value = YAML::Load(text);
  } catch (const YAML::Exception&) {
    value = YAML::Node(text);
  }
  const std::string problem = apply(key, value);
  if (!problem.empty()) throw InputError(printable("\"" + assignment + "\": " + problem));
}

std::string ConfigSchema::dump() const {
  return dump_section("", 0);
}

std::string ConfigSchema::dump_section(const std::string& prefix, std::size_t depth) const {
  const std::string indent(2 * depth, ' ');
  std::string text;
  std::set<std::string> done;
  for (const Entry& entry : entries_) {
    if (!entry.key.starts_with(prefix)) continue;
    const std::string name =
        entry.key.substr(prefix.size(), entry.key.find('.', prefix.size()) - prefix.size());
    if (!done.insert(name).second) continue;
    if (prefix + name == entry.key) {
      if (!entry.help.empty()) text += indent + "# " + entry.help + entry.permitted + "\n";
      text += indent + name + ": " + entry.print() + "\n";
    } else {
      text += indent + name + ":\n" + dump_section(prefix + name + ".", depth + 1);
    }
  }
  return text;
}

}  // namespace surefield
