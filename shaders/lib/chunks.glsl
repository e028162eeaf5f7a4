// How the passes of shaders/sort/ share out n consecutive elements: invocation w of all takes the consecutive elements
// from w * chunk_length(...) on. Pieces have at least `least` elements, so that a small n occupies few invocations.
#ifndef SUREFIELD_LIB_CHUNKS_GLSL
#define SUREFIELD_LIB_CHUNKS_GLSL

uint chunk_length(uint n, uint workers, uint least) {
  return max(least, (n + workers - 1) / workers);
}

#endif
