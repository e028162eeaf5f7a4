#include "tools/tables/table_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

nlohmann::json parse_json(const std::filesystem::path& file) {
  nlohmann::json json = nlohmann::json::parse(read_file(file), nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded())
    throw InputError(file, "is no JSON; remove its folder and run tools/reproduce again");
  return json;
}

bool is_completed(const std::filesystem::path& run) {
  const std::filesystem::path metrics = run / "metrics.json";
  return std::filesystem::exists(metrics) && parse_json(metrics).value("status", "") == "completed";
}

}  // namespace

std::vector<PublishedValue> read_published(const std::filesystem::path& file) {
  std::vector<PublishedValue> values;
  for (const TextLine& line : read_lines(file)) {
    const std::vector<std::string> cells = split(line.text, ',');
    if (cells.size() != 6) {
      throw InputError(file, line.number, "expected table,method,metric,column,value,source");
    }
    if (cells[0] != "table") values.push_back({cells[0], cells[1], cells[2], cells[3], cells[4], cells[5]});
  }
  return values;
}

std::map<int, std::filesystem::path> ReproducedRuns::seeds(const std::string& place) const {
  std::map<int, std::filesystem::path> found;
  if (!std::filesystem::is_directory(root_ / place)) return found;
  for (const auto& entry : std::filesystem::directory_iterator(root_ / place)) {
    const std::string name = entry.path().filename().string();
    int seed = 0;
    if (std::sscanf(name.c_str(), "seed%d", &seed) == 1 && is_completed(entry.path()))
      found[seed] = entry.path();
  }
  return found;
}

std::map<int, double> ReproducedRuns::numbers(const std::string& place, const NumberSource& source) const {
  std::map<int, double> numbers;
  const nlohmann::json::json_pointer pointer(source.pointer);
  for (const auto& [seed, folder] : seeds(place)) {
    if (!std::filesystem::exists(folder / source.file)) continue;
    const nlohmann::json json = parse_json(folder / source.file);
    if (json.contains(pointer) && json[pointer].is_number())
      numbers[seed] = source.factor * json[pointer].get<double>();
  }
  return numbers;
}

std::vector<std::string> ReproducedRuns::origins(const std::string& place) const {
  std::vector<std::string> lines;
  for (const auto& [seed, folder] : seeds(place)) {
    const nlohmann::json json = parse_json(folder / "metrics.json");
    const auto at = [&](const char* pointer) {
      return json.value(nlohmann::json::json_pointer(pointer), nlohmann::json("?"));
    };
    const auto text = [&](const char* pointer) {
      const nlohmann::json value = at(pointer);
      return value.is_string() ? value.get<std::string>() : value.dump();
    };
    const std::string line =
        fmt::format("commit {} on {}, images of {} x {}", text("/program/commit"), text("/device/name"),
                    text("/dataset/width"), text("/dataset/height"));
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }
  return lines;
}

std::string Spread::text(int decimals) const {
  if (!deviation) return fmt::format("{:.{}f}", mean, decimals);
  return fmt::format("{:.{}f} ± {:.{}f}", mean, decimals, *deviation, decimals);
}

std::optional<Spread> spread_of(const std::vector<double>& numbers) {
  if (numbers.empty()) return std::nullopt;
  Spread spread;
  for (double number : numbers) spread.mean += number / static_cast<double>(numbers.size());
  if (numbers.size() < 2) return spread;
  double squares = 0;
  for (double number : numbers) squares += (number - spread.mean) * (number - spread.mean);
  spread.deviation = std::sqrt(squares / static_cast<double>(numbers.size() - 1));
  return spread;
}

}  // namespace surefield
