// Adam (Kingma and Ba) with the constants that Gaussian splatting uses.

const float ADAM_BETA1 = 0.9;
const float ADAM_BETA2 = 0.999;
const float ADAM_EPSILON = 1e-15;

/// The bias corrections at step t = 1, 2, ...: 1 / (1 - beta1^t), 1 / (1 - beta2^t).
vec2 adam_corrections(uint t) {
  return vec2(1 / (1 - pow(ADAM_BETA1, float(t))), 1 / (1 - pow(ADAM_BETA2, float(t))));
}

// The step to subtract, for a rate of 1; advances the moments m and v.
#define DEFINE_ADAM_STEP(type)                                                            \
  type adam_step(type g, inout type m, inout type v, vec2 corrections) {                  \
    m = ADAM_BETA1 * m + (1 - ADAM_BETA1) * g;                                            \
    v = ADAM_BETA2 * v + (1 - ADAM_BETA2) * g * g;                                        \
    return m * corrections.x / (sqrt(v * corrections.y) + ADAM_EPSILON);                  \
  }
DEFINE_ADAM_STEP(float)
DEFINE_ADAM_STEP(vec3)
DEFINE_ADAM_STEP(vec4)
