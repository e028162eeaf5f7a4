#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace surefield {

/// A published value of one cell of a table.
struct PublishedValue {
  std::string table;
  std::string method;
  std::string metric;
  std::string column;
  std::string value;  ///< as printed; "-" where there is none
  std::string source;
};

/// Reads tools/published.csv. Throws InputError with the line that cannot be read.
std::vector<PublishedValue> read_published(const std::filesystem::path& file);

/// Where a number of a run stands: the file in the run's folder, the JSON pointer in it, and the factor that
/// takes it to the unit of the table.
struct NumberSource {
  std::string file;
  std::string pointer;
  double factor = 1;
};

/// The completed runs that tools/reproduce has left: folders SET/SCENE/VARIANT/seedN below `root`.
class ReproducedRuns {
 public:
  explicit ReproducedRuns(std::filesystem::path root) : root_(std::move(root)) {}

  /// A number of every seed that has it, by the seed.
  std::map<int, double> numbers(const std::string& place, const NumberSource& source) const;

  /// Lines that tell what made the runs of a set and scene: programs, devices, sizes of images.
  std::vector<std::string> origins(const std::string& place) const;

 private:
  std::map<int, std::filesystem::path> seeds(const std::string& place) const;

  std::filesystem::path root_;
};

/// Mean and sample standard deviation of numbers.
struct Spread {
  double mean = 0;
  std::optional<double> deviation;  ///< of two numbers or more

  /// "1.23 ± 0.04", or the mean alone.
  std::string text(int decimals) const;
};

/// nullopt for no numbers.
std::optional<Spread> spread_of(const std::vector<double>& numbers);

}  // namespace surefield
