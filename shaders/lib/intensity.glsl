/// Brightness of a colour, as television weighs the channels (Rec. 601).
float intensity_of(vec3 colour) {
  return dot(colour, vec3(0.299, 0.587, 0.114));
}
