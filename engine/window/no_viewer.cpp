// Takes the place of the viewer where the program is built without GLFW or Dear ImGui.
#include "engine/types/error.h"
#include "engine/window/viewer.h"

namespace surefield {

std::string viewer_problem() {
  return "this program was built without GLFW and Dear ImGui: install libglfw3-dev and libimgui-dev, and "
         "build "
         "it again";
}

std::vector<std::string> show_viewer(ViewerInput) {
  throw InputError(viewer_problem());
}

}  // namespace surefield
