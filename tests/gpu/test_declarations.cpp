#include <doctest/doctest.h>

#include <set>
#include <string>

#include "all_passes.h"
#include "tests/gpu/spirv_interface.h"

using namespace surefield;

namespace {

/// Compares the C++ side of a pass, made by declare_pass.h, with the module that its shader became.
template <class P>
void check_pass() {
  CAPTURE(std::string(P::name));
  const testing::SpirvInterface shader = testing::read_interface(gpu::spirv(P::name));

  CHECK(shader.bindings.size() == std::size(P::binding_table));
  for (const gpu::BindingInfo& declared : P::binding_table) {
    CAPTURE(std::string(declared.name));
    const auto found = shader.bindings.find(declared.slot);
    REQUIRE_MESSAGE(found != shader.bindings.end(), "the shader does not use this buffer");
    CHECK(found->second.set == 0);
    CHECK(found->second.stride == declared.stride);
    CHECK(found->second.read_only == (declared.access == gpu::Access::Read));
  }

  CHECK(shader.params_bytes == P::params_bytes);

  CHECK(shader.size_from_constant);
  const typename P::Constants defaults;
  const auto constants = P::constant_list(defaults);
  CHECK(shader.constants.contains(0));
  CHECK(shader.constants.size() == 1 + constants.size());
  for (uint32_t i = 0; i < constants.size(); ++i) {
    CAPTURE(i + 1);
    const auto found = shader.constants.find(i + 1);
    REQUIRE_MESSAGE(found != shader.constants.end(), "the shader does not use this constant");
    CHECK(found->second == constants[i]);
  }
}

}  // namespace

TEST_CASE("the declaration of every pass equals its SPIR-V") {
#define CHECK_PASS(name) check_pass<passes::name>();
  SUREFIELD_ALL_PASSES(CHECK_PASS)
#undef CHECK_PASS
}

TEST_CASE("the slots of a pass are distinct"){
#define CHECK_SLOTS(name)                                                               \
  {                                                                                     \
    std::set<uint32_t> slots;                                                           \
    for (const auto& binding : passes::name::binding_table) slots.insert(binding.slot); \
    CHECK_MESSAGE(slots.size() == std::size(passes::name::binding_table), #name);       \
  }
    SUREFIELD_ALL_PASSES(CHECK_SLOTS)
#undef CHECK_SLOTS
}

TEST_CASE("the SPIR-V reader refuses what is not SPIR-V") {
  const std::vector<uint32_t> noise(20, 0x12345678);
  CHECK_THROWS_AS(testing::read_interface(noise), std::runtime_error);
  const auto inside_an_instruction = gpu::spirv("test_scale").first(10);
  CHECK_THROWS_AS(testing::read_interface(inside_an_instruction), std::runtime_error);
}
