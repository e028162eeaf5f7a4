// Visual words.
#include "engine/places/vocabulary.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("words.txt", surefield::read_vocabulary)
