#include "engine/window/swapchain.h"

#include <algorithm>

#include "engine/gpu/error.h"

namespace surefield {

using gpu::check;

Swapchain::Swapchain(const gpu::Device& device, VkSurfaceKHR surface)
    : gpu_(device.window_handles()), surface_(surface) {
  VkBool32 can_present = VK_FALSE;
  check(vkGetPhysicalDeviceSurfaceSupportKHR(gpu_.physical, gpu_.queue_family, surface_, &can_present),
        "asking whether the device can present");
  if (!can_present) {
    vkDestroySurfaceKHR(gpu_.instance, surface_, nullptr);
    throw gpu::Error(gpu::Error::Kind::MissingFeature,
                     device.report().name + " cannot show windows on this display: choose another --device");
  }
  choose_format();
  create_render_pass();
}

Swapchain::~Swapchain() {
  destroy_targets();
  vkDestroySwapchainKHR(gpu_.device, swapchain_, nullptr);
  vkDestroyRenderPass(gpu_.device, render_pass_, nullptr);
  vkDestroySurfaceKHR(gpu_.instance, surface_, nullptr);
}

void Swapchain::choose_format() {
  uint32_t count = 0;
  vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physical, surface_, &count, nullptr);
  std::vector<VkSurfaceFormatKHR> formats(count);
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physical, surface_, &count, formats.data()),
        "listing the formats of the window");
  // Colours of maps and of the user interface are encoded already, so no format that encodes them again.
  const auto plain = [](const VkSurfaceFormatKHR& f) {
    return f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM;
  };
  const auto found = std::find_if(formats.begin(), formats.end(), plain);
  format_ = found == formats.end() ? formats.at(0) : *found;
}

void Swapchain::create_render_pass() {
  VkAttachmentDescription attachment{};
  attachment.format = format_.format;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  attachment.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  attachment.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 1;
  info.pAttachments = &attachment;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  check(vkCreateRenderPass(gpu_.device, &info, nullptr, &render_pass_), "creating a render pass");
}

void Swapchain::resize(const Eigen::Vector2i& pixels) {
  VkSurfaceCapabilitiesKHR able;
  check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_.physical, surface_, &able), "asking about the window");
  extent_ = able.currentExtent;
  if (extent_.width == UINT32_MAX)
    extent_ = {
        std::clamp(static_cast<uint32_t>(pixels.x()), able.minImageExtent.width, able.maxImageExtent.width),
        std::clamp(static_cast<uint32_t>(pixels.y()), able.minImageExtent.height,
                   able.maxImageExtent.height)};
  VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
  info.surface = surface_;
  info.minImageCount =
      std::max(able.minImageCount, able.maxImageCount == 0 ? 3u : std::min(3u, able.maxImageCount));
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = able.currentTransform;
  const bool opaque = able.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  info.compositeAlpha = opaque ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  VkSwapchainKHR successor = VK_NULL_HANDLE;
  const VkResult result = vkCreateSwapchainKHR(gpu_.device, &info, nullptr, &successor);
  destroy_targets();
  vkDestroySwapchainKHR(gpu_.device, swapchain_, nullptr);
  swapchain_ = successor;
  check(result, "creating the window's images");
  create_targets();
}

void Swapchain::create_targets() {
  uint32_t count = 0;
  vkGetSwapchainImagesKHR(gpu_.device, swapchain_, &count, nullptr);
  std::vector<VkImage> images(count);
  check(vkGetSwapchainImagesKHR(gpu_.device, swapchain_, &count, images.data()),
        "listing the window's images");
  for (VkImage image : images) {
    Target& target = targets_.emplace_back();
    target.image = image;
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(vkCreateImageView(gpu_.device, &view, nullptr, &target.view), "creating a view of the window");
    VkFramebufferCreateInfo frame{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    frame.renderPass = render_pass_;
    frame.attachmentCount = 1;
    frame.pAttachments = &target.view;
    frame.width = extent_.width;
    frame.height = extent_.height;
    frame.layers = 1;
    check(vkCreateFramebuffer(gpu_.device, &frame, nullptr, &target.framebuffer), "creating a frame buffer");
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    check(vkCreateSemaphore(gpu_.device, &semaphore, nullptr, &target.drawn), "creating a semaphore");
  }
}

void Swapchain::destroy_targets() {
  for (const Target& target : targets_) {
    vkDestroySemaphore(gpu_.device, target.drawn, nullptr);
    vkDestroyFramebuffer(gpu_.device, target.framebuffer, nullptr);
    vkDestroyImageView(gpu_.device, target.view, nullptr);
  }
  targets_.clear();
}

std::optional<uint32_t> Swapchain::acquire(VkSemaphore free) {
  if (!swapchain_) return std::nullopt;
  uint32_t index = 0;
  const VkResult result =
      vkAcquireNextImageKHR(gpu_.device, swapchain_, UINT64_MAX, free, VK_NULL_HANDLE, &index);
  if (result == VK_ERROR_OUT_OF_DATE_KHR) return std::nullopt;
  if (result != VK_SUBOPTIMAL_KHR) check(result, "waiting for an image of the window");
  return index;
}

bool Swapchain::present(uint32_t index) {
  VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &targets_[index].drawn;
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &index;
  const VkResult result = vkQueuePresentKHR(gpu_.queue, &info);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) return false;
  check(result, "showing an image in the window");
  return true;
}

}  // namespace surefield
