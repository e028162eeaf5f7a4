#include "engine/window/interface.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <filesystem>

#include "engine/gpu/error.h"

namespace surefield {

namespace {

constexpr float kTextSize = 16;  // pixels, where the screen asks for no larger ones
constexpr uint32_t kImages = 3;  // of vertices, at least one for each that is in work

void check_result(VkResult result) {
  gpu::check(result, "drawing the user interface");
}

/// A font that most systems have; else the one that ImGui carries, which is small.
void load_font(float scale) {
  const char* file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  ImFontConfig config;
  config.SizePixels = 13 * scale;
  if (std::filesystem::exists(file))
    ImGui::GetIO().Fonts->AddFontFromFileTTF(file, kTextSize * scale);
  else
    ImGui::GetIO().Fonts->AddFontDefault(&config);
}

VkDescriptorPool create_pool(VkDevice device) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  info.maxSets = 8;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  gpu::check(vkCreateDescriptorPool(device, &info, nullptr, &pool), "creating a descriptor pool");
  return pool;
}

}  // namespace

Interface::Interface(const GlfwWindow& window, const gpu::Device& device, Presenter& presenter)
    : gpu_(device.window_handles()), pool_(create_pool(device.handle())) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // nothing is left behind
  ImGui::StyleColorsDark();
  ImGui::GetStyle().ScaleAllSizes(window.scale());
  ImGui::GetStyle().WindowRounding = 4;
  load_font(window.scale());
  ImGui_ImplGlfw_InitForVulkan(window.handle(), /*install_callbacks=*/true);
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = gpu_.instance;
  info.PhysicalDevice = gpu_.physical;
  info.Device = gpu_.device;
  info.QueueFamily = gpu_.queue_family;
  info.Queue = gpu_.queue;
  info.DescriptorPool = pool_;
  info.MinImageCount = info.ImageCount = kImages;
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = check_result;
  ImGui_ImplVulkan_Init(&info, presenter.swapchain().render_pass());
#if IMGUI_VERSION_NUM < 19000
  presenter.run([](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
#else
  ImGui_ImplVulkan_CreateFontsTexture();
#endif
}

Interface::~Interface() {
  vkQueueWaitIdle(gpu_.queue);
  ImGui_ImplVulkan_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  vkDestroyDescriptorPool(gpu_.device, pool_, nullptr);
}

void Interface::lay_out(const std::function<void()>& panels) {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  panels();
  ImGui::Render();
}

void Interface::draw(VkCommandBuffer commands) const {
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

bool Interface::has_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}

bool Interface::has_keyboard() const {
  return ImGui::GetIO().WantTextInput;
}

}  // namespace surefield
