// How the fields of settings are bound to keys: parsing, checking and printing of each type.
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <type_traits>

#include "engine/config/config.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

template <typename T>
std::optional<T> parse_number(const YAML::Node& node, Range range) {
  if (!node.IsScalar()) return std::nullopt;
  std::string_view text = node.Scalar();
  if (text.starts_with('+')) text.remove_prefix(1);
  T number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  // Written so that NaN is refused too.
  if (!(number >= range.min && number <= range.max)) return std::nullopt;
  return number;
}

std::string describe(Range range) {
  return fmt::format("from {} to {}", range.min, range.max);
}

std::string print_text(const std::string& text) {
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << text;
  return emitter.c_str();
}

std::string join(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

template <typename T>
std::function<std::string(const YAML::Node&)> number_parser(T* value, Range range, const char* kind) {
  return [=](const YAML::Node& node) -> std::string {
    const auto number = parse_number<T>(node, range);
    if (!number) return fmt::format("{} {}", kind, describe(range));
    *value = *number;
    return {};
  };
}

template <typename T>
std::function<std::string()> number_printer(const T* value) {
  return [value] { return fmt::format("{}", *value); };
}

std::string permitted(Range range) {
  return fmt::format(" [{} to {}]", range.min, range.max);
}

}  // namespace

template <typename T>
void ConfigSchema::add_number(const std::string& key, T* value, Range range, const char* kind) {
  const auto number = [=] {
    return NumberSetting{key, {}, range, std::is_integral_v<T>, static_cast<double>(*value)};
  };
  add_entry({key, permitted(range), false, number_parser(value, range, kind), number_printer(value), number});
}

void ConfigSchema::add(const std::string& key, int* value, Range range) {
  add_number(key, value, range, "a whole number");
}

void ConfigSchema::add(const std::string& key, float* value, Range range) {
  add_number(key, value, range, "a number");
}

void ConfigSchema::add(const std::string& key, double* value, Range range) {
  add_number(key, value, range, "a number");
}

void ConfigSchema::add(const std::string& key, bool* value) {
  const auto parse = [value](const YAML::Node& node) -> std::string {
    if (!node.IsScalar() || (node.Scalar() != "true" && node.Scalar() != "false")) return "true or false";
    *value = node.Scalar() == "true";
    return {};
  };
  add_entry({key, "", false, parse, [value] { return std::string(*value ? "true" : "false"); }});
}

void ConfigSchema::add(const std::string& key, std::string* value) {
  const auto parse = [value](const YAML::Node& node) -> std::string {
    if (!node.IsScalar() || !is_utf8(node.Scalar())) return "text in UTF-8";
    *value = node.Scalar();
    return {};
  };
  add_entry({key, "", false, parse, [value] { return print_text(*value); }});
}

void ConfigSchema::add(const std::string& key, std::vector<double>* value, Range range) {
  add(key, value, range, {value->size()});
}

void ConfigSchema::add(const std::string& key, std::vector<double>* value, Range range,
                       std::vector<std::size_t> sizes) {
  const auto parse = [=](const YAML::Node& node) -> std::string {
    const std::string expected =
        fmt::format("a list of {} numbers {}", fmt::join(sizes, ", "), describe(range));
    if (!node.IsSequence() || std::find(sizes.begin(), sizes.end(), node.size()) == sizes.end())
      return expected;
    std::vector<double> numbers;
    for (const YAML::Node& item : node) {
      const auto number = parse_number<double>(item, range);
      if (!number) return expected;
      numbers.push_back(*number);
    }
    *value = numbers;
    return {};
  };
  add_entry(
      {key, permitted(range), true, parse, [value] { return fmt::format("[{}]", fmt::join(*value, ", ")); }});
}

void ConfigSchema::add(const std::string& key, std::string* value, const std::vector<std::string>& names) {
  const auto store = [value, names](std::size_t i) { *value = names[i]; };
  const auto load = [value, names] {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), *value) - names.begin());
  };
  add_choice(key, names, store, load);
}

void ConfigSchema::add_choice(const std::string& key, const std::vector<std::string>& names,
                              std::function<void(std::size_t)> store, std::function<std::size_t()> load) {
  if (load() >= names.size()) throw UsageError("the default of " + key + " is not among its choices");
  const auto parse = [=](const YAML::Node& node) -> std::string {
    const auto name = node.IsScalar() ? std::find(names.begin(), names.end(), node.Scalar()) : names.end();
    if (name == names.end()) return "one of " + join(names);
    store(static_cast<std::size_t>(name - names.begin()));
    return {};
  };
  const auto print = [=] { return print_text(names.at(load())); };
  add_entry({key, fmt::format(" [{}]", join(names)), false, parse, print});
}

}  // namespace surefield
