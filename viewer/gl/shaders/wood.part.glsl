// Planed wood: fibres drawn out along the grain, and years that run through them.

float fibre_chance(ivec2 at) {
  uint v = uint(at.x) * 1597334677u ^ uint(at.y) * 3812015801u;
  v = (v ^ (v >> 15u)) * 2246822519u;
  return float(v >> 8u) / 16777216.0;
}

// Noise from 0 to 1 between the points of a grid.
float fibres(vec2 at) {
  ivec2 cell = ivec2(floor(at));
  vec2 part = fract(at);
  part *= part * (3.0 - 2.0 * part);
  float low = mix(fibre_chance(cell), fibre_chance(cell + ivec2(1, 0)), part.x);
  return mix(low, mix(fibre_chance(cell + ivec2(0, 1)), fibre_chance(cell + 1), part.x), part.y);
}

// Its colour at a place along and across the grain, metres. What is finer than a pixel fades out.
vec3 wood(vec3 tint, vec2 at_m) {
  float blur_m = fwidth(at_m.y) + 0.05 * fwidth(at_m.x);
  float bow = fibres(at_m * vec2(0.9, 7.0));
  float years = at_m.y * 60.0 + 9.0 * bow;
  float ring = abs(fract(years) - 0.5) * 2.0;
  ring = mix(0.5, ring * ring, clamp(1.3 - 90.0 * blur_m, 0.0, 1.0));
  float fine = mix(0.5, fibres(at_m * vec2(14.0, 700.0)), clamp(1.3 - 500.0 * blur_m, 0.0, 1.0));
  return tint * (0.72 + 0.22 * ring + 0.24 * fine + 0.28 * bow);
}
