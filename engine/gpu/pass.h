#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "engine/gpu/buffer.h"
#include "engine/gpu/glsl_types.h"

namespace surefield::gpu {

enum class Access { Read, Write, Update };

/// One line of a pass's list of bindings (shaders/shared/declare_pass.h builds the tables).
struct BindingInfo {
  const char* name;
  uint32_t slot;
  Access access;
  uint32_t stride;  ///< bytes of one entry
};

/// What a pipeline is made from.
struct PassInfo {
  const char* name;
  std::span<const BindingInfo> bindings;
  uint32_t params_bytes;
  std::span<const uint32_t> constants;  ///< specialisation constants 1, 2, ... (0 is the workgroup size)
};

/// SPIR-V of shaders/**/<name>.comp, embedded at build time. Throws Error(Driver) for an unknown name.
std::span<const uint32_t> spirv(std::string_view name);

/// The untyped part of Pass: a compute pipeline with its layouts. The pipeline is built in the background.
class Pipeline {
 public:
  Pipeline(Device& device, const PassInfo& info, uint32_t workgroup_size);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;

  const char* name() const { return name_; }
  std::span<const BindingInfo> bindings() const { return bindings_; }
  uint32_t params_bytes() const { return params_bytes_; }
  uint32_t workgroup_size() const { return workgroup_size_; }
  /// Waits until the pipeline is there. Throws the Error that kept it from being built.
  VkPipeline handle() const { return pipeline_.get(); }
  VkPipelineLayout layout() const { return layout_; }
  VkDescriptorSetLayout set_layout() const { return set_layout_; }

 private:
  void create_layouts();
  VkPipeline create_pipeline(std::span<const uint32_t> code, const std::vector<uint32_t>& values,
                             VkPipelineCache cache) const;
  void destroy();

  Device& device_;
  const char* name_;
  std::span<const BindingInfo> bindings_;
  uint32_t params_bytes_;
  uint32_t workgroup_size_;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  std::shared_future<VkPipeline> pipeline_;
};

/// Workgroup size of passes over pixels or Gaussians: as small as holds the widest subgroup, so that little
/// is idle.
inline constexpr uint32_t kWorkgroup = 64;

/// A compute pass `P` (a struct of surefield::passes, declared once in shaders/shared/), ready to be
/// dispatched.
template <class P>
class Pass : public Pipeline {
 public:
  Pass(Device& device, uint32_t workgroup_size, const typename P::Constants& constants = {})
      : Pipeline(device, {P::name, P::binding_table, P::params_bytes, P::constant_list(constants)},
                 workgroup_size) {}

  /// Workgroups that give each of `count` elements an invocation.
  uint32_t groups(uint64_t count) const {
    return static_cast<uint32_t>((count + workgroup_size() - 1) / workgroup_size());
  }
};

}  // namespace surefield::gpu
