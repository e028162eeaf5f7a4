#include "tools/shared/ui_scale.h"

namespace surefield {

CLI::Option* add_ui_scale_option(CLI::App& command, double& scale) {
  return command
      .add_option("--ui-scale", scale,
                  "How many times larger than usual the window's text and controls are, as 2 on a screen of "
                  "small pixels; default: as the screen asks")
      ->check(CLI::Range(0.5, 4.0));
}

}  // namespace surefield
