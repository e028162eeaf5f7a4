// Colour images, by their content.
#include "engine/io/images.h"
#include "tests/fuzz/harness.h"

SUREFIELD_FUZZ_FILE("colour.png", surefield::read_colour)
