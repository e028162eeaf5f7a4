// Rows, fields and numbers of text files.
#include "engine/io/text_file.h"
#include "tests/fuzz/harness.h"

namespace {

/// What is a number as a whole must be one field, and the fields of a row have no blanks at their ends.
void read(const std::filesystem::path& file) {
  for (const surefield::TextLine& line : surefield::read_rows(file)) {
    const auto numbers = surefield::parse_numbers(line.text);
    const auto fields = surefield::split_fields(line.text);
    if (numbers && fields.size() != numbers->size()) __builtin_trap();
    if (numbers) surefield::rigid_from_rows(*numbers);
  }
}

}  // namespace

SUREFIELD_FUZZ_FILE("text.txt", read)
