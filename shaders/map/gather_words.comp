#version 460
#extension GL_GOOGLE_include_directive : require
#include "gather_words.h"

// One invocation per Gaussian of the new map.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.count) return;
  const uint source = sources[i];
  const uint at = (source & ~SOURCE_KIND) * params.words;
  const bool zero = params.only_kept == 1 && (source & SOURCE_KIND) != SOURCE_KEPT;
  for (uint w = 0; w < params.words; ++w) to[i * params.words + w] = zero ? 0 : from[at + w];
}
