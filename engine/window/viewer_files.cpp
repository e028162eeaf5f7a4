// What the viewer writes.
#include <fmt/format.h>

#include "engine/formats/ply.h"
#include "engine/io/camera_json.h"
#include "engine/io/images.h"
#include "engine/types/error.h"
#include "engine/window/viewer_app.h"

namespace surefield {

std::filesystem::path ViewerApp::free_name(const std::string& stem, const std::string& extension) const {
  for (int i = 1;; ++i) {
    const auto file = input_.out / fmt::format("{}_{:04}.{}", stem, i, extension);
    if (!std::filesystem::exists(file)) return file;
  }
}

void ViewerApp::save_screenshot() {
  if (repaint_) paint(window_.pixels());
  try {
    const auto file = free_name("screenshot", "png");
    const auto size = painter_.size();
    write_png(file, painter_.picture());
    auto camera_file = file;
    write_camera(camera_file.replace_extension("json"),
                 camera_.camera(static_cast<int>(size.width), static_cast<int>(size.height)));
    message_ = "saved " + file.string();
  } catch (const InputError& error) {
    message_ = error.what();
  }
}

void ViewerApp::save_map() {
  try {
    const auto file = free_name("map", "ply");
    write_ply(file, input_.map);
    message_ = "saved " + file.string();
  } catch (const InputError& error) {
    message_ = error.what();
  }
}

}  // namespace surefield
