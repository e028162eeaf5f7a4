// What the passes of the radix sort agree on.
#ifndef SUREFIELD_SHARED_SORT_SHAPE_H
#define SUREFIELD_SHARED_SORT_SHAPE_H
#include "language.h"

SHARED_TYPES_BEGIN
const uint SORT_DIGITS_MAX = 256;  // a digit has 8 bits at most
SHARED_TYPES_END

#endif
