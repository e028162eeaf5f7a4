#include "engine/io/number_table.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>
#include <utility>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

std::string with_blanks_for(std::string text, const char* separators) {
  for (char& c : text)
    if (std::string_view(separators).find(c) != std::string_view::npos) c = ' ';
  return text;
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

bool has_number(const std::string& text) {
  const std::vector<std::string> words = words_of(text);
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return parse_numbers(word).has_value(); });
}

/// Names in lower case, a column each: units in brackets and the sign of a comment are left out.
std::vector<std::string> column_names(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (auto open = text.find('['); open != std::string::npos; open = text.find('[')) {
    const auto close = text.find(']', open);
    text.erase(open, close == std::string::npos ? close : close - open + 1);
  }
  return words_of(with_blanks_for(std::move(text), "#,;\"'"));
}

/// The last comment above the first row; empty where there is none.
std::string comment_above(const std::string& content) {
  std::istringstream stream(content);
  std::string comment;
  for (std::string line; std::getline(stream, line);) {
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos) continue;
    const auto mark = line.find('#');
    // A byte order mark may stand before the first one.
    if (mark == std::string::npos || mark > first + 3) break;
    comment = line.substr(mark);
  }
  return comment;
}

}  // namespace

NumberTable read_number_table(const std::filesystem::path& file) {
  NumberTable table;
  table.names = column_names(comment_above(read_file(file)));
  bool is_first = true;
  for (const TextLine& line : read_lines(file)) {
    const std::string text = with_blanks_for(line.text, ",;");
    auto numbers = parse_numbers(text);
    if (!numbers) {
      if (!is_first || has_number(text)) {
        throw InputError(file, line.number, "\"" + line.text.substr(0, 60) + "\" are no numbers");
      }
      table.names = column_names(line.text);
    } else {
      if (table.rows.empty()) table.has_commas = line.text.find(',') != std::string::npos;
      table.rows.push_back({line.number, *std::move(numbers)});
    }
    is_first = false;
  }
  return table;
}

}  // namespace surefield
