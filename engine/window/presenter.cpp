#include "engine/window/presenter.h"

#include "engine/gpu/error.h"

namespace surefield {

using gpu::check;

namespace {

constexpr VkImageSubresourceRange kWhole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
constexpr VkImageSubresourceLayers kLayer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

/// One side of a change of an image's layout.
struct ImageUse {
  VkImageLayout layout;
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
};

constexpr ImageUse kNothing{VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0};
constexpr ImageUse kCopyTarget{VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                               VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr ImageUse kCopySource{VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                               VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr ImageUse kDrawing{VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                            VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};

void change_layout(VkCommandBuffer commands, VkImage image, const ImageUse& from, const ImageUse& to) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = from.stage;
  barrier.srcAccessMask = from.access;
  barrier.dstStageMask = to.stage;
  barrier.dstAccessMask = to.access;
  barrier.oldLayout = from.layout;
  barrier.newLayout = to.layout;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = kWhole;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

bool encodes_srgb(VkFormat format) {
  return format == VK_FORMAT_B8G8R8A8_SRGB || format == VK_FORMAT_R8G8B8A8_SRGB;
}

}  // namespace

Presenter::Presenter(gpu::Device& device, VkSurfaceKHR surface)
    : device_(device), gpu_(device.window_handles()), swapchain_(device, surface) {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = gpu_.queue_family;
  check(vkCreateCommandPool(gpu_.device, &pool, nullptr, &pool_), "creating a command pool");
  VkCommandBufferAllocateInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  commands.commandPool = pool_;
  commands.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(gpu_.device, &commands, &commands_), "allocating a command buffer");
  const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  check(vkCreateSemaphore(gpu_.device, &semaphore, nullptr, &free_), "creating a semaphore");
  const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  check(vkCreateFence(gpu_.device, &fence, nullptr, &done_), "creating a fence");
}

Presenter::~Presenter() {
  vkQueueWaitIdle(gpu_.queue);
  destroy_image();
  vkDestroyFence(gpu_.device, done_, nullptr);
  vkDestroySemaphore(gpu_.device, free_, nullptr);
  vkDestroyCommandPool(gpu_.device, pool_, nullptr);
}

void Presenter::begin() {
  check(vkResetCommandPool(gpu_.device, pool_, 0), "resetting a command pool");
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands_, &info), "beginning a command buffer");
}

/// Submits what was recorded and waits for it.
void Presenter::finish(VkSemaphore wait, VkSemaphore signal) {
  check(vkEndCommandBuffer(commands_), "ending a command buffer");
  VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  buffer.commandBuffer = commands_;
  VkSemaphoreSubmitInfo semaphores[2] = {{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO},
                                         {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO}};
  semaphores[0].semaphore = wait;
  semaphores[0].stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
  semaphores[1].semaphore = signal;
  semaphores[1].stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  submit.waitSemaphoreInfoCount = wait ? 1 : 0;
  submit.pWaitSemaphoreInfos = &semaphores[0];
  submit.commandBufferInfoCount = 1;
  submit.pCommandBufferInfos = &buffer;
  submit.signalSemaphoreInfoCount = signal ? 1 : 0;
  submit.pSignalSemaphoreInfos = &semaphores[1];
  check(vkQueueSubmit2(gpu_.queue, 1, &submit, done_), "drawing the window");
  check(vkWaitForFences(gpu_.device, 1, &done_, VK_TRUE, UINT64_MAX), "drawing the window");
  check(vkResetFences(gpu_.device, 1, &done_), "resetting a fence");
}

void Presenter::run(const std::function<void(VkCommandBuffer)>& record) {
  begin();
  record(commands_);
  finish(VK_NULL_HANDLE, VK_NULL_HANDLE);
}

void Presenter::destroy_image() {
  vkDestroyImage(gpu_.device, image_, nullptr);
  vkFreeMemory(gpu_.device, image_memory_, nullptr);
  image_ = VK_NULL_HANDLE;
  image_memory_ = VK_NULL_HANDLE;
}

void Presenter::reserve_image(const ImageSize& size) {
  if (image_ && size.width == image_size_.width && size.height == image_size_.height) return;
  destroy_image();
  image_size_ = size;
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  // The bytes are colours as they are to be shown: where the window's format encodes, this one decodes.
  info.format = encodes_srgb(swapchain_.format()) ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {size.width, size.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  check(vkCreateImage(gpu_.device, &info, nullptr, &image_), "creating the picture of the window");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(gpu_.device, image_, &needs);
  VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  memory.allocationSize = needs.size;
  memory.memoryTypeIndex = device_.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  check(vkAllocateMemory(gpu_.device, &memory, nullptr, &image_memory_),
        "allocating the picture of the window");
  check(vkBindImageMemory(gpu_.device, image_, image_memory_, 0), "binding the picture of the window");
}

void Presenter::record_picture(const gpu::Buffer& picture, VkImage target) {
  const auto corner = [](uint32_t width, uint32_t height) {
    return VkOffset3D{static_cast<int32_t>(width), static_cast<int32_t>(height), 1};
  };
  change_layout(commands_, image_, kNothing, kCopyTarget);
  VkBufferImageCopy copy{};
  copy.imageSubresource = kLayer;
  copy.imageExtent = {image_size_.width, image_size_.height, 1};
  vkCmdCopyBufferToImage(commands_, picture.handle(), image_, kCopyTarget.layout, 1, &copy);
  change_layout(commands_, image_, kCopyTarget, kCopySource);
  change_layout(commands_, target, kNothing, kCopyTarget);
  VkImageBlit blit{};
  blit.srcSubresource = blit.dstSubresource = kLayer;
  blit.srcOffsets[1] = corner(image_size_.width, image_size_.height);
  blit.dstOffsets[1] = corner(swapchain_.extent().width, swapchain_.extent().height);
  vkCmdBlitImage(commands_, image_, kCopySource.layout, target, kCopyTarget.layout, 1, &blit,
                 VK_FILTER_NEAREST);
  change_layout(commands_, target, kCopyTarget, kDrawing);
}

void Presenter::record_interface(const Swapchain::Target& target,
                                 const std::function<void(VkCommandBuffer)>& draw) {
  VkRenderPassBeginInfo begin_pass{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  begin_pass.renderPass = swapchain_.render_pass();
  begin_pass.framebuffer = target.framebuffer;
  begin_pass.renderArea.extent = swapchain_.extent();
  vkCmdBeginRenderPass(commands_, &begin_pass, VK_SUBPASS_CONTENTS_INLINE);
  draw(commands_);
  vkCmdEndRenderPass(commands_);
}

void Presenter::show(const gpu::Array<glsl::uint>& picture, const ImageSize& size,
                     const Eigen::Vector2i& window, const std::function<void(VkCommandBuffer)>& draw) {
  if (window != window_) {
    vkQueueWaitIdle(gpu_.queue);
    swapchain_.resize(window);
    window_ = window;
  }
  const auto index = swapchain_.acquire(free_);
  if (!index) {
    window_.setZero();
    return;
  }
  const Swapchain::Target& target = swapchain_.target(*index);
  reserve_image(size);
  begin();
  record_picture(picture.buffer(), target.image);
  record_interface(target, draw);
  finish(free_, target.drawn);
  if (!swapchain_.present(*index)) window_.setZero();
}

}  // namespace surefield
