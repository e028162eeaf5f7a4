// The list of pairs that TUM's associate.py makes and that many recordings come with: "stamp file stamp
// file".
#include <array>
#include <cmath>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/sources/layouts.h"
#include "engine/sources/stamped_rows.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::array kNames = {"associations.txt", "associate.txt", "association.txt", "associated.txt",
                               "assoc.txt"};

bool is_depth(const std::string& name) {
  return name.find("depth") != std::string::npos || name.find("Depth") != std::string::npos;
}

/// Two stamps, each before its file; which of them is colour, the names tell.
StoredFrame parse_pair(const std::filesystem::path& file, const TextLine& line) {
  const std::vector<std::string> fields = split_fields(line.text);
  const auto stamp = [&](std::size_t i) { return parse_number(fields[i]).value_or(NAN); };
  if (fields.size() != 4 || !std::isfinite(stamp(0)) || !std::isfinite(stamp(2)) ||
      is_depth(fields[1]) == is_depth(fields[3])) {
    throw InputError(file, line.number, "expected \"stamp rgb/file stamp depth/file\", in either order");
  }
  const std::size_t colour = is_depth(fields[1]) ? 2 : 0, depth = 2 - colour;
  const double unit = stamp_unit(stamp(0));
  return {stamp(colour) * unit, file.parent_path() / fields[colour + 1],
          file.parent_path() / fields[depth + 1], stamp(depth) * unit};
}

}  // namespace

std::optional<std::filesystem::path> find_pair_list(const std::filesystem::path& folder) {
  for (const char* name : kNames)
    if (file_exists(folder / name)) return folder / name;
  return std::nullopt;
}

std::vector<StoredFrame> read_pair_list(const std::filesystem::path& file, StoredSequence& sequence) {
  return read_stamped_rows(file, sequence, [&](const TextLine& line) { return parse_pair(file, line); });
}

}  // namespace surefield
