#include "engine/formats/ply_records.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "engine/io/text_file.h"
#include "engine/types/error.h"

static_assert(std::endian::native == std::endian::little,
              "PLY files are read in the byte order of the machine");

namespace surefield {

namespace {

template <typename T>
double load_as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

double load_scalar(PlyType type, const char* bytes) {
  switch (type) {
    case PlyType::int8:
      return load_as<int8_t>(bytes);
    case PlyType::uint8:
      return load_as<uint8_t>(bytes);
    case PlyType::int16:
      return load_as<int16_t>(bytes);
    case PlyType::uint16:
      return load_as<uint16_t>(bytes);
    case PlyType::int32:
      return load_as<int32_t>(bytes);
    case PlyType::uint32:
      return load_as<uint32_t>(bytes);
    case PlyType::float32:
      return load_as<float>(bytes);
    case PlyType::float64:
      return load_as<double>(bytes);
  }
  return 0;
}

/// The length of a list, when `value` can be one. The bound keeps the conversion exact.
std::optional<std::size_t> list_length(double value) {
  if (!(value >= 0) || value > 4e9 || value != std::floor(value)) return std::nullopt;
  return static_cast<std::size_t>(value);
}

}  // namespace

PlyRecordReader::PlyRecordReader(const std::filesystem::path& file, const PlyHeader& header)
    : file_(file), is_ascii_(header.is_ascii), stream_(file, std::ios::binary) {
  stream_.seekg(static_cast<std::streamoff>(header.data_offset));
  left_ = std::filesystem::file_size(file) - header.data_offset;
}

void PlyRecordReader::next(const PlyElement& element, PlyRecord& record) {
  record.values.clear();
  record.starts.clear();
  if (is_ascii_) {
    next_ascii(element, record);
  } else {
    next_binary(element, record);
  }
  record.starts.push_back(record.values.size());
}

void PlyRecordReader::next_binary(const PlyElement& element, PlyRecord& record) {
  for (const PlyProperty& property : element.properties) {
    record.starts.push_back(record.values.size());
    const auto length = property.list_length ? list_length(read_scalar(*property.list_length)) : 1;
    // A damaged length asks for no more memory than the file has bytes for.
    if (!length || *length > left_ / ply_type_size(property.type)) fail(element);
    for (std::size_t i = 0; i < *length && stream_; ++i) {
      record.values.push_back(read_scalar(property.type));
    }
    if (!stream_) fail(element);
  }
}

void PlyRecordReader::next_ascii(const PlyElement& element, PlyRecord& record) {
  if (!std::getline(stream_, line_)) fail(element);
  const auto numbers = parse_numbers(line_);
  if (!numbers) fail(element);
  std::size_t read = 0;
  for (const PlyProperty& property : element.properties) {
    record.starts.push_back(record.values.size());
    std::optional<std::size_t> length = 1;
    if (property.list_length && read < numbers->size()) length = list_length((*numbers)[read++]);
    if (!length || *length > numbers->size() - read) fail(element);
    const auto first = numbers->begin() + static_cast<std::ptrdiff_t>(read);
    record.values.insert(record.values.end(), first, first + static_cast<std::ptrdiff_t>(*length));
    read += *length;
  }
  if (read != numbers->size()) fail(element);
}

double PlyRecordReader::read_scalar(PlyType type) {
  char bytes[8] = {};
  const std::size_t size = ply_type_size(type);
  stream_.read(bytes, static_cast<std::streamsize>(size));
  left_ -= std::min<std::uintmax_t>(left_, size);
  return load_scalar(type, bytes);
}

void PlyRecordReader::fail(const PlyElement& element) const {
  throw InputError(file_, "ends or is damaged before its last " + element.name + "; copy or write it again");
}

}  // namespace surefield
