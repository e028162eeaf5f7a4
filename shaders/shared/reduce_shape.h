// How a sum of floats is cut into chunks. The order of additions follows from these numbers and from the number of
// values, and from nothing else: the sum of the same values is the same on every device.
#ifndef SUREFIELD_SHARED_REDUCE_SHAPE_H
#define SUREFIELD_SHARED_REDUCE_SHAPE_H
#include "language.h"

SHARED_TYPES_BEGIN
const uint REDUCE_CHUNKS = 4096;     // at most so many chunks
const uint REDUCE_CHUNK_LEAST = 64;  // of at least so many values
const uint REDUCE_LANES = 64;        // invocations of the workgroup that sums the chunks
SHARED_TYPES_END

#endif
