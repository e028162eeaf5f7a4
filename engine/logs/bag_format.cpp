#include "engine/logs/bag_format.h"

#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr uint32_t kLongestHead = 1 << 20;

}  // namespace

BagFields::BagFields(std::string_view bytes, const std::filesystem::path& name) : name_(name) {
  ByteCursor cursor(bytes, name);
  while (!cursor.at_end()) {
    const std::string_view field = cursor.counted();
    const auto equals = field.find('=');
    if (equals == std::string_view::npos) throw InputError(name, "is damaged: a field has no name");
    fields_.emplace(field.substr(0, equals), field.substr(equals + 1));
  }
}

std::string_view BagFields::text(std::string_view field) const {
  const auto found = fields_.find(field);
  return found == fields_.end() ? std::string_view() : found->second;
}

int64_t BagFields::stamp(std::string_view field) const {
  return bag_stamp(number<uint64_t>(field));
}

int64_t bag_stamp(uint64_t seconds_and_nanoseconds) {
  constexpr int64_t kNanoseconds = 1000000000;
  return static_cast<int64_t>(seconds_and_nanoseconds & UINT32_MAX) * kNanoseconds +
         static_cast<int64_t>(seconds_and_nanoseconds >> 32);
}

BagRecord read_bag_record(const ByteFile& file, uint64_t at) {
  const auto length_at = [&](uint64_t place) {
    const std::string bytes = file.read(place, sizeof(uint32_t));
    ByteCursor cursor(bytes, file.path());
    return cursor.number<uint32_t>();
  };
  const uint32_t head_size = length_at(at);
  if (head_size > kLongestHead) throw InputError(file.path(), "is damaged: the head of a record is too long");
  BagRecord record;
  record.head = file.read(at + sizeof(uint32_t), head_size);
  record.data_size = length_at(at + sizeof(uint32_t) + head_size);
  record.data_at = at + 2 * sizeof(uint32_t) + head_size;
  if (record.data_size > file.size() - record.data_at)
    throw InputError(file.path(), "ends too early; it may have been cut off");
  return record;
}

BagRecordView next_bag_record(ByteCursor& cursor) {
  const std::string_view head = cursor.counted();
  return {head, cursor.counted()};
}

std::string unpack_bag_chunk(const ByteFile& file, const BagRecord& record) {
  const BagFields fields(record.head, file.path());
  if (fields.op() != BagOp::Chunk)
    throw InputError(file.path(), "is damaged: there is no chunk where one should be");
  const auto packing = packing_of(fields.text("compression"));
  if (!packing || *packing == Packing::Zstd) {
    throw InputError(file.path(), "packs its chunks in a way that is not known: " +
                                      printable(std::string(fields.text("compression"))));
  }
  if (record.data_size > kLargestChunk) throw InputError(file.path(), "is damaged: a chunk is too large");
  return unpack(file.read(record.data_at, record.data_size), *packing, fields.number<uint32_t>("size"),
                file.path());
}

}  // namespace surefield
