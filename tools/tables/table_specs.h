#pragma once

#include <string>
#include <vector>

#include "tools/tables/table_values.h"

namespace surefield {

/// One measure of a table.
struct TableMetric {
  std::string name;
  int decimals = 2;
  NumberSource source;
  std::optional<NumberSource> times = std::nullopt;  ///< "value x count", as for milliseconds and iterations
  std::optional<NumberSource> divisor = std::nullopt;  ///< of the value, or of the count where there is one
  bool larger_is_better = false;
};

/// A kind of run with its name in a table.
struct TableVariant {
  std::string folder;
  std::string name;
};

/// A table of the paper, or one of our own.
struct TableSpec {
  std::string id;  ///< names it on the command line and in published.csv
  std::string title;
  std::string set;                  ///< folder of its runs
  std::vector<std::string> scenes;  ///< folders below, and columns
  std::vector<TableMetric> metrics;
  std::vector<TableVariant> variants = {{"full", "Surefield"}};
  bool metrics_as_columns = false;  ///< for the mean over all scenes; else one row for each
  std::string compared_with;  ///< the variant that the others are compared with, by its folder, in place of
                              ///< published values; the first metric has a column for each scene too
};

/// All tables, in the order in which they are written.
const std::vector<TableSpec>& table_specs();

}  // namespace surefield
