#pragma once

#include <string>

namespace surefield {

/// configs/vocabulary.txt as it was when the program was built.
const std::string& built_in_vocabulary_text();

}  // namespace surefield
