#pragma once

#include <string>

#include "tools/tables/table_results.h"

namespace surefield {

/// A table of variants with its heading: the mean of each metric over the scenes in which the variant that
/// the others are compared with was run, the first metric in each of them, and below which variants are
/// better or worse by more than the spread over seeds. Empty where that variant was not run.
std::string comparison_markdown(const TableSpec& spec, const OwnResults& results);

}  // namespace surefield
