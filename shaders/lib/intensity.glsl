/// How much the channels count in the brightness of a colour (Rec. 601, of television).
const vec3 INTENSITY = vec3(0.299, 0.587, 0.114);

/// Brightness of a colour.
float intensity_of(vec3 colour) {
  return dot(colour, INTENSITY);
}
