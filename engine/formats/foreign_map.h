#pragma once

#include <filesystem>
#include <string>

namespace surefield {

/// What a map is that another program wrote in a format that is not read here, and how to convert it, as the
/// end of a sentence about the file; empty where the file shows no such format. Told by the content, and by
/// the ending of the name where that fits. Throws InputError when the file cannot be opened.
std::string foreign_map_format(const std::filesystem::path& file);

}  // namespace surefield
