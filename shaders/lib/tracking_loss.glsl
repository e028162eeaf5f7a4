// The loss of tracking (paper eq. 19) from its masked sums. Needs loss_types.h.

/// Whether any pixel of the render can be compared with the frame.
bool is_comparable(TrackSums s) {
  return s.colour_pixels > 0 || s.depth_pixels > 0;
}

float tracking_loss(TrackSums s, float weight_colour, float weight_depth) {
  return weight_colour * s.colour / max(s.colour_pixels, 1) + weight_depth * s.depth / max(s.depth_pixels, 1);
}
