// Copies the entries of one attribute to their new places when the map is rebuilt.
#include "splat_types.h"

#define PASS gather_words
#define PASS_PARAMS(P)                                                       \
  P(uint, count) P(uint, words) /* 32-bit words of an entry */               \
  P(uint, only_kept)            /* 1: entries of newborn Gaussians are zero */
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, uint, sources) READ(1, uint, from) WRITE(2, uint, to)
#include "declare_pass.h"
