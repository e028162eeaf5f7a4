// The window of SSIM: 11 x 11 Gaussian, sigma 1.5, taken as two passes of 11 taps; outside of the image there is zero.
// Needs loss_types.h.

const int WINDOW_RADIUS = 5;
const float WINDOW[11] = float[](0.00102838008, 0.00759875814, 0.0360007721, 0.10936069,
                                 0.213005538, 0.266011725, 0.213005538, 0.10936069,
                                 0.0360007721, 0.00759875814, 0.00102838008);

/// Neighbouring outputs that one invocation computes, so that every input is loaded once and not 11 times; signed,
/// like the offsets that it is added to.
const int STRIP = int(SSIM_STRIP);

const float SSIM_C1 = 0.01 * 0.01;
const float SSIM_C2 = 0.03 * 0.03;
