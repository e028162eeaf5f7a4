#pragma once

#include <filesystem>
#include <string>

namespace surefield {

/// A table of the ratios, second over first, of all figures that two files of `surefield bench --json` have
/// in common. Throws InputError that names the file which is none.
std::string compare_benchmarks(const std::filesystem::path& first, const std::filesystem::path& second);

}  // namespace surefield
