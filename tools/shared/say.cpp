#include "tools/shared/say.h"

#include "tools/shared/interrupt.h"

namespace surefield {

void say_text(std::FILE* to, const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), to) == text.size() && std::fflush(to) == 0;
  if (!written) interrupt();
}

}  // namespace surefield
