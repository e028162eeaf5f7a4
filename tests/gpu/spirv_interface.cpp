#include "tests/gpu/spirv_interface.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace surefield::testing {

namespace {

// Numbers of the SPIR-V specification.
enum Op : uint32_t {
  OpTypeInt = 21,
  OpTypeFloat = 22,
  OpTypeVector = 23,
  OpTypeArray = 28,
  OpTypeRuntimeArray = 29,
  OpTypeStruct = 30,
  OpTypePointer = 32,
  OpConstant = 43,
  OpSpecConstant = 50,
  OpVariable = 59,
  OpDecorate = 71,
  OpMemberDecorate = 72,
  OpExecutionModeId = 331
};
enum Decoration : uint32_t {
  SpecId = 1,
  ArrayStride = 6,
  NonWritable = 24,
  Binding = 33,
  DescriptorSet = 34,
  Offset = 35
};
enum StorageClass : uint32_t { PushConstant = 9, StorageBuffer = 12 };
constexpr uint32_t kMagic = 0x07230203, kHeaderWords = 5, kLocalSizeId = 38;

using Words = std::vector<uint32_t>;

/// A module taken apart: declarations by id, decorations by (id, decoration) and (id, member, decoration).
struct Module {
  std::map<uint32_t, std::pair<uint32_t, Words>> types;  ///< id -> opcode, operands
  std::map<uint32_t, uint32_t> constants, spec_constants;
  std::map<uint32_t, std::pair<uint32_t, uint32_t>> variables;  ///< id -> type, storage class
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> decorations;
  std::map<std::tuple<uint32_t, uint32_t, uint32_t>, uint32_t> member_decorations;
  bool size_from_constant = false;

  bool has(uint32_t id, Decoration decoration) const { return decorations.contains({id, decoration}); }
  uint32_t get(uint32_t id, Decoration decoration) const {
    const auto found = decorations.find({id, decoration});
    if (found == decorations.end()) throw std::runtime_error("SPIR-V: a decoration is missing");
    return found->second;
  }
};

void take_instruction(Module& module, uint32_t opcode, const Words& operands) {
  const auto value = [&](std::size_t i) { return i < operands.size() ? operands[i] : 0; };
  switch (opcode) {
    case OpTypeInt:
    case OpTypeFloat:
    case OpTypeVector:
    case OpTypeArray:
    case OpTypeRuntimeArray:
    case OpTypeStruct:
    case OpTypePointer:
      module.types[value(0)] = {opcode, Words(operands.begin() + 1, operands.end())};
      break;
    case OpConstant:
      module.constants[value(1)] = value(2);
      break;
    case OpSpecConstant:
      module.spec_constants[value(1)] = value(2);
      break;
    case OpVariable:
      module.variables[value(1)] = {value(0), value(2)};
      break;
    case OpDecorate:
      module.decorations[{value(0), value(1)}] = value(2);
      break;
    case OpMemberDecorate:
      module.member_decorations[{value(0), value(1), value(2)}] = value(3);
      break;
    case OpExecutionModeId:
      module.size_from_constant |= value(1) == kLocalSizeId;
      break;
    default:
      break;
  }
}

Module take_apart(std::span<const uint32_t> words) {
  if (words.size() < kHeaderWords || words[0] != kMagic) throw std::runtime_error("not SPIR-V");
  Module module;
  for (std::size_t at = kHeaderWords; at < words.size();) {
    const uint32_t length = words[at] >> 16, opcode = words[at] & 0xffff;
    if (length == 0 || at + length > words.size()) throw std::runtime_error("SPIR-V: cut off");
    take_instruction(module, opcode, Words(words.begin() + at + 1, words.begin() + at + length));
    at += length;
  }
  return module;
}

/// Bytes of a type in scalar layout.
uint32_t size_of(const Module& module, uint32_t type) {
  const auto& [opcode, operands] = module.types.at(type);
  switch (opcode) {
    case OpTypeInt:
    case OpTypeFloat:
      return operands[0] / 8;
    case OpTypeVector:
      return operands[1] * size_of(module, operands[0]);
    case OpTypeArray:
      return module.constants.at(operands[1]) * module.get(type, ArrayStride);
    case OpTypeStruct: {
      uint32_t end = 0;
      for (uint32_t m = 0; m < operands.size(); ++m)
        end = std::max(end, module.member_decorations.at({type, m, Offset}) + size_of(module, operands[m]));
      return end;
    }
    default:
      throw std::runtime_error("SPIR-V: a type without a size");
  }
}

SpirvBinding read_binding(const Module& module, uint32_t variable, uint32_t block) {
  const Words& members = module.types.at(block).second;
  if (members.size() != 1 || module.types.at(members[0]).first != OpTypeRuntimeArray)
    throw std::runtime_error("SPIR-V: a storage buffer is not one runtime array");
  return {.set = module.get(variable, DescriptorSet),
          .stride = module.get(members[0], ArrayStride),
          .read_only = module.has(variable, NonWritable) ||
                       module.member_decorations.contains({block, 0, NonWritable})};
}

}  // namespace

SpirvInterface read_interface(std::span<const uint32_t> words) {
  const Module module = take_apart(words);
  SpirvInterface interface;
  interface.size_from_constant = module.size_from_constant;
  for (const auto& [id, variable] : module.variables) {
    const auto& [pointer, storage] = variable;
    if (storage != StorageBuffer && storage != PushConstant) continue;
    const uint32_t block = module.types.at(pointer).second[1];
    if (storage == PushConstant) interface.params_bytes = size_of(module, block);
    if (storage == StorageBuffer)
      interface.bindings[module.get(id, Binding)] = read_binding(module, id, block);
  }
  for (const auto& [id, value] : module.spec_constants) interface.constants[module.get(id, SpecId)] = value;
  return interface;
}

}  // namespace surefield::testing
