// Adds up what each term of each source says of the pose that was found.
#include "align_types.h"

#define PASS align_evidence
#define PASS_PARAMS(P) P(uint, count) /* of partial sums of a part */ P(uint, parts)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, uint, partial_sums) /* AlignSums */ \
  WRITE(1, uint, evidence) /* AlignSums */
#include "declare_pass.h"
