#include "engine/gpu/pass.h"

#include <vector>

#include "engine/gpu/error.h"

namespace surefield::gpu {

Pipeline::Pipeline(Device& device, const PassInfo& info, uint32_t workgroup_size)
    : device_(device),
      name_(info.name),
      bindings_(info.bindings),
      params_bytes_(info.params_bytes),
      workgroup_size_(workgroup_size) {
  try {
    create_layouts();
    std::vector<uint32_t> constants{workgroup_size};
    constants.insert(constants.end(), info.constants.begin(), info.constants.end());
    pipeline_ = device.build_pipeline([this, code = spirv(name_), constants](VkPipelineCache cache) {
      return create_pipeline(code, constants, cache);
    });
  } catch (...) {
    destroy();
    throw;
  }
}

Pipeline::~Pipeline() {
  destroy();
}

void Pipeline::destroy() {
  if (pipeline_.valid()) {
    try {
      vkDestroyPipeline(device_.handle(), pipeline_.get(), nullptr);
    } catch (...) {
      // It was never built; handle() has said so to those who asked.
    }
  }
  vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_.handle(), set_layout_, nullptr);
}

void Pipeline::create_layouts() {
  std::vector<VkDescriptorSetLayoutBinding> slots;
  for (const BindingInfo& binding : bindings_)
    slots.push_back(
        {binding.slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  if (device_.limits().push_descriptors) set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = static_cast<uint32_t>(slots.size());
  set.pBindings = slots.data();
  check(vkCreateDescriptorSetLayout(device_.handle(), &set, nullptr, &set_layout_), name_);

  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, params_bytes_};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &set_layout_;
  layout.pushConstantRangeCount = params_bytes_ ? 1 : 0;
  layout.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(device_.handle(), &layout, nullptr, &layout_), name_);
}

VkPipeline Pipeline::create_pipeline(std::span<const uint32_t> code, const std::vector<uint32_t>& values,
                                     VkPipelineCache cache) const {
  VkShaderModuleCreateInfo module_info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  module_info.codeSize = code.size_bytes();
  module_info.pCode = code.data();
  VkShaderModule module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device_.handle(), &module_info, nullptr, &module), name_);

  std::vector<VkSpecializationMapEntry> entries;
  for (uint32_t i = 0; i < values.size(); ++i) entries.push_back({i, i * 4, 4});
  const VkSpecializationInfo specialization{static_cast<uint32_t>(entries.size()), entries.data(),
                                            values.size() * 4, values.data()};

  VkPipelineShaderStageRequiredSubgroupSizeCreateInfo subgroup{
      VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
  subgroup.requiredSubgroupSize = device_.limits().subgroup_size;
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization;
  if (device_.limits().require_subgroup_size) info.stage.pNext = &subgroup;
  if (workgroup_size_ % device_.limits().subgroup_size == 0)
    info.stage.flags = VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
  info.layout = layout_;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result = vkCreateComputePipelines(device_.handle(), cache, 1, &info, nullptr, &pipeline);
  vkDestroyShaderModule(device_.handle(), module, nullptr);
  check(result, name_);
  return pipeline;
}

}  // namespace surefield::gpu
