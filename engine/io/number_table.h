#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace surefield {

/// One line of a table of numbers.
struct NumberRow {
  int line = 0;  ///< from 1
  std::vector<double> values;
};

/// A text file of numbers, a row a line, between blanks, commas or semicolons.
struct NumberTable {
  std::vector<NumberRow> rows;     ///< without empty lines and comments
  std::vector<std::string> names;  ///< of the columns, lower case, from the last line of text above the rows
  bool has_commas = false;         ///< whether the first row has any
};

/// Reads a table. One line without a number may stand above the rows: their names. Throws InputError naming
/// the line where anything but numbers stands further down.
NumberTable read_number_table(const std::filesystem::path& file);

}  // namespace surefield
