#include "engine/formats/ply_header.h"

#include <charconv>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kLongestHeader = 1 << 16;  // bytes; keeps a wrong file from being searched to its end
constexpr const char* kHeaderEnd = "end_header";

std::optional<PlyType> parse_type(const std::string& name) {
  static const std::map<std::string, PlyType> types = {
      {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
      {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
      {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
      {"float64", PlyType::float64}};
  const auto found = types.find(name);
  return found == types.end() ? std::nullopt : std::optional(found->second);
}

/// The text of the header up to and including the line end_header.
std::string read_header_text(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) throw InputError(file, "no such file; check the path");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file, "cannot be opened; check its permissions");
  std::string start(kLongestHeader, '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  if (!start.starts_with("ply\n") && !start.starts_with("ply\r\n")) {
    throw InputError(file, "is no PLY file: it does not start with \"ply\"");
  }
  const auto end = start.find(std::string("\n") + kHeaderEnd);
  const auto newline = end == std::string::npos ? end : start.find('\n', end + 1);
  if (newline == std::string::npos)
    throw InputError(file, "its PLY header does not end; the file is cut off");
  return start.substr(0, newline + 1);
}

/// Takes one header line after another.
class HeaderParser {
 public:
  HeaderParser(const std::filesystem::path& file, PlyHeader& header) : file_(file), header_(header) {}

  void take(const std::string& line, int number) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    line_ = number;
    if (keyword == "format") take_format(words);
    if (keyword == "element") take_element(words);
    if (keyword == "property") take_property(words);
    if (keyword == "comment") take_comment(words);
  }

  void finish() const {
    if (!has_format_) throw InputError(file_, "its PLY header names no format");
    if (header_.elements.empty() || (header_.is_compressed() && header_.elements.size() < 2)) {
      throw InputError(file_, "its PLY header has no element vertex");
    }
    for (const PlyElement& element : header_.elements) {
      if (!element.properties.empty()) continue;
      throw InputError(file_, "its PLY header gives the element " + element.name + " no property");
    }
  }

 private:
  void take_format(std::istringstream& words) {
    std::string format;
    words >> format;
    if (format != "ascii" && format != "binary_little_endian") {
      fail("the format \"" + format + "\" is not supported; convert it to binary_little_endian");
    }
    header_.is_ascii = format == "ascii";
    has_format_ = true;
  }

  void take_element(std::istringstream& words) {
    PlyElement element;
    std::string count;
    words >> element.name >> count;
    const bool may_be_chunk = header_.elements.empty();
    const bool must_be_vertex = may_be_chunk || (header_.elements.size() == 1 && header_.is_compressed());
    if (must_be_vertex && element.name != "vertex" && !(may_be_chunk && element.name == "chunk")) {
      fail("the first element must be vertex, it is \"" + element.name + "\"");
    }
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || end != count.data() + count.size() || count.empty()) {
      fail("\"" + count + "\" is no number of records");
    }
    header_.elements.push_back(std::move(element));
  }

  void take_property(std::istringstream& words) {
    if (header_.elements.empty()) fail("a property stands before the first element");
    std::string type_name;
    PlyProperty property;
    words >> type_name;
    if (type_name == "list" && header_.elements.size() > 1) {
      std::string length_name;
      words >> length_name >> type_name;
      property.list_length = parse_type(length_name);
      if (!property.list_length) fail("\"" + length_name + "\" is no type for the length of a list");
    }
    words >> property.name;
    const auto type = parse_type(type_name);
    if (!type || property.name.empty()) {
      const std::string& element = header_.elements.back().name;
      fail("a property of type \"" + type_name + "\" is not possible in the element " + element);
    }
    property.type = *type;
    header_.elements.back().properties.push_back(std::move(property));
  }

  void take_comment(std::istringstream& words) {
    std::string text;
    std::getline(words >> std::ws, text);
    if (text.ends_with('\r')) text.pop_back();
    header_.comments.push_back(std::move(text));
  }

  [[noreturn]] void fail(const std::string& problem) const { throw InputError(file_, line_, problem); }

  const std::filesystem::path& file_;
  PlyHeader& header_;
  int line_ = 0;
  bool has_format_ = false;
};

/// The fewest bytes that a record of the element takes.
std::size_t shortest_record(const PlyElement& element, bool is_ascii) {
  if (is_ascii) return 2 * element.properties.size();  // a digit and a separator each
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties)
    bytes += ply_type_size(property.list_length.value_or(property.type));
  return bytes;
}

/// Refuses counts that the file cannot hold, so that a damaged header asks for no absurd amount of memory.
void check_length(const std::filesystem::path& file, const PlyHeader& header) {
  std::size_t data = std::filesystem::file_size(file) - header.data_offset;
  if (header.is_ascii) ++data;  // the last separator may be missing
  for (const PlyElement& element : header.elements) {
    const std::size_t shortest = shortest_record(element, header.is_ascii);
    if (element.count > data / shortest) {
      throw InputError(file, "holds fewer " + (element.name == "vertex" ? "vertices" : element.name + "s") +
                                 " than its header says (" + std::to_string(element.count) +
                                 "); the file is cut off");
    }
    data -= element.count * shortest;
  }
}

}  // namespace

std::size_t ply_type_size(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

std::optional<std::size_t> PlyElement::find(const std::string& property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return i;
  }
  return std::nullopt;
}

PlyHeader read_ply_header(const std::filesystem::path& file) {
  const std::string text = read_header_text(file);
  PlyHeader header;
  header.data_offset = text.size();
  HeaderParser parser(file, header);
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) parser.take(line, number);
  parser.finish();
  check_length(file, header);
  return header;
}

}  // namespace surefield
