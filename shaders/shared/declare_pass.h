// Turns the declaration of one pass into GLSL interface blocks or into C++ types. No include guard: every pass header
// of this folder includes it last, after defining
//   PASS                                a name, that of the .comp file
//   PASS_CONSTANTS(C)                   C(id, NAME, default) per specialisation constant, ids 1, 2, ... in order
//   PASS_PARAMS(P)                      P(type, name) per push constant; 128 bytes at most
//   PASS_BINDINGS(READ, WRITE, UPDATE)  READ(slot, type, name) per buffer, an array of `type`; UPDATE reads and writes
// Constants and parameters may be left out.
#ifndef PASS_CONSTANTS
#define PASS_CONSTANTS(C)
#endif
#ifndef PASS_PARAMS
#define PASS_PARAMS(P)
#define PASS_HAS_NO_PARAMS
#endif

#ifdef __cplusplus

namespace surefield::passes {
using namespace glsl;  // so that one list serves both languages

struct PASS {
  static constexpr const char* name = SUREFIELD_STRING(PASS);

  struct Constants {
#define C(id, NAME, value) uint NAME = value;
    PASS_CONSTANTS(C)
#undef C
  };

  struct Params {
#define P(type, field) type field;
    PASS_PARAMS(P)
#undef P
  };
#ifdef PASS_HAS_NO_PARAMS
  static constexpr std::uint32_t params_bytes = 0;
#else
  static constexpr std::uint32_t params_bytes = sizeof(Params);
#endif
  static_assert(params_bytes <= 128, "Vulkan promises 128 bytes of push constants");

  struct Bindings {
#define B(slot, type, field) gpu::Ref<type> field;
    PASS_BINDINGS(B, B, B)
#undef B
  };

#define READ(slot, type, field) {#field, slot, gpu::Access::Read, sizeof(type)},
#define WRITE(slot, type, field) {#field, slot, gpu::Access::Write, sizeof(type)},
#define UPDATE(slot, type, field) {#field, slot, gpu::Access::Update, sizeof(type)},
  static constexpr gpu::BindingInfo binding_table[] = {PASS_BINDINGS(READ, WRITE, UPDATE)};
#undef READ
#undef WRITE
#undef UPDATE

  static std::array<gpu::Slice, std::size(binding_table)> slices(const Bindings& b) {
#define B(slot, type, field) b.field.slice(),
    return {PASS_BINDINGS(B, B, B)};
#undef B
  }

  static std::span<const std::uint32_t> constant_list([[maybe_unused]] const Constants& c) {
#define C(id, NAME, value) +1
    constexpr std::size_t count = 0 PASS_CONSTANTS(C);
#undef C
    return {reinterpret_cast<const std::uint32_t*>(&c), count};
  }
};

}  // namespace surefield::passes

#else

#define C(id, NAME, value) layout(constant_id = id) const uint NAME = value;
PASS_CONSTANTS(C)
#undef C

#ifndef PASS_HAS_NO_PARAMS
#define P(type, field) type field;
layout(push_constant, scalar) uniform Params { PASS_PARAMS(P) } params;
#undef P
#endif

#define READ(slot, type, field) layout(set = 0, binding = slot, scalar) restrict readonly buffer field##_block { type field[]; };
#define WRITE(slot, type, field) layout(set = 0, binding = slot, scalar) restrict buffer field##_block { type field[]; };
#define UPDATE(slot, type, field) layout(set = 0, binding = slot, scalar) restrict buffer field##_block { type field[]; };
PASS_BINDINGS(READ, WRITE, UPDATE)
#undef READ
#undef WRITE
#undef UPDATE

layout(local_size_x_id = 0) in;

#endif

#undef PASS
#undef PASS_CONSTANTS
#undef PASS_PARAMS
#undef PASS_BINDINGS
#ifdef PASS_HAS_NO_PARAMS
#undef PASS_HAS_NO_PARAMS
#endif
