// Planed wood: fibres drawn out along the grain, and years that run through them.

// Its colour at a place along and across the grain, metres. What is finer than a pixel fades out.
vec3 wood(vec3 tint, vec2 at_m) {
  float blur_m = fwidth(at_m.y) + 0.05 * fwidth(at_m.x);
  float bow = grain(at_m * vec2(0.9, 7.0));
  float years = at_m.y * 60.0 + 9.0 * bow;
  float ring = abs(fract(years) - 0.5) * 2.0;
  ring = mix(0.5, ring * ring, clamp(1.3 - 90.0 * blur_m, 0.0, 1.0));
  float fine = mix(0.5, grain(at_m * vec2(14.0, 700.0)), clamp(1.3 - 500.0 * blur_m, 0.0, 1.0));
  return tint * (0.72 + 0.22 * ring + 0.24 * fine + 0.28 * bow);
}
