// From dL/d(images) at a pixel to what the backward passes need there. Needs splat_types.h.

/// `image`: colour and opacity, `geo`: the geometry image; `sensor`: the sensor's depth, where U is 0 if it is invalid.
PixelUpstream upstream_of(PixelGradient g, vec4 image, vec4 geo, float sensor, vec3 background) {
  const float normalised = image.w > 0 ? g.depth_normalised / image.w : 0;
  PixelUpstream p;
  p.colour = g.colour;
  p.depth = g.depth + normalised;
  p.constant = g.opacity - dot(g.colour, background) - (image.w > 0 ? normalised * geo.x / image.w : 0);
  p.median = g.depth_median;
  p.uncertainty = sensor > 0 ? g.uncertainty : 0;
  p.total = dot(p.colour, image.rgb - (1 - image.w) * background) + p.depth * geo.x + p.constant * image.w +
            p.uncertainty * geo.z;
  return p;
}
