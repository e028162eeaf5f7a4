// ScanNet's recordings: the header, and the first frames.
#include <algorithm>

#include "engine/sources/sens_file.h"
#include "tests/fuzz/harness.h"

namespace {

void read(const std::filesystem::path& file) {
  const surefield::SensFile sens = surefield::read_sens_file(file);
  for (int i = 0; i < static_cast<int>(std::min<std::size_t>(sens.frames.size(), 3)); ++i)
    surefield::fuzz::expect_answer([&] { surefield::read_sens_frame(sens, i); });
}

}  // namespace

SUREFIELD_FUZZ_FILE("recording.sens", read)
