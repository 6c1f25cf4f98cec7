// Behind sward.part.glsl: the earth at a shore, dry and wet: the bank, and the bed that is seen through the water.
float chance_of(vec2 cell) { return fract(sin(dot(cell, vec2(127.1, 311.7))) * 43758.5453); }

// Stones of a size that is seen in pixels of `pixel_m`, one in a cell at most: how far up one looks on a stone (0: on the earth), and its tint.
vec2 stones(vec2 at_m, float size_m, float share, float pixel_m) {
  if (pixel_m > 0.5 * size_m) return vec2(0.0);
  vec2 at = at_m / size_m;
  vec2 cell = floor(at);
  float which = chance_of(cell);
  vec2 off = at - cell - 0.5 - 0.24 * (vec2(chance_of(cell + 17.0), chance_of(cell + 41.0)) - 0.5);
  float turn = 6.2831853 * which;
  off = mat2(cos(turn), sin(turn), -sin(turn), cos(turn)) * off;
  off *= vec2(1.0, 1.2 + 0.8 * fract(which * 71.0));
  float high = 1.0 - dot(off, off) / (0.10 + 0.07 * fract(which * 37.0));
  return high > 0.0 && fract(which * 91.0) < share ? vec2(sqrt(high), fract(which * 53.0)) : vec2(0.0);
}

// The colour of the earth at a place that is this much above the water. `height`: a bump, for its light.
vec3 earth_at(vec2 at_m, float above_m, float pixel_m, out float height) {
  float broad = texture(noise_tile, at_m * 0.11).r;
  // Without the broad waves of the tile, which one would see come again every 0.77 m.
  vec2 fine_at = at_m * 1.3 + 0.3;
  float fine = clamp(0.5 + texture(noise_tile, fine_at).r - textureLod(noise_tile, fine_at, 5.0).r, 0.0, 1.0);
  vec3 earth = mix(vec3(0.105, 0.080, 0.052), vec3(0.205, 0.165, 0.112), 0.35 * broad + 0.65 * fine);
  height = 0.35 * fine;
  // Gravel where the waves wash, silt with some stones below.
  float washed = exp(-above_m * above_m / 0.006) * smoothstep(0.30, 0.62, broad + 0.25);
  vec2 gravel = stones(mat2(0.8, 0.6, -0.6, 0.8) * at_m, 0.034, 0.20 + 0.70 * washed, pixel_m);
  vec2 pebbles = stones(at_m, 0.075, 0.08 + 0.45 * washed, pixel_m);
  vec2 cobbles = stones(mat2(0.6, -0.8, 0.8, 0.6) * at_m, 0.21, 0.03 + 0.18 * washed, pixel_m);
  vec2 stone = cobbles.x > 0.0 ? cobbles : (pebbles.x > 0.0 ? pebbles : gravel);
  if (stone.x > 0.0) {
    vec3 grey = mix(vec3(0.085, 0.078, 0.070), vec3(0.25, 0.225, 0.185), stone.y * stone.y);
    vec3 lit = grey * (0.70 + 0.45 * fine) * (0.45 + 0.55 * smoothstep(0.0, 0.55, stone.x));
    earth = mix(lit, earth, smoothstep(0.006, 0.06, pixel_m));
    height = 0.4 + 0.6 * stone.x;
  }
  // Wet earth is darker: what the water on it throws back does not come out again.
  float wet = 1.0 - smoothstep(0.004, 0.055, above_m + 0.02 * (broad - 0.5));
  return earth * mix(vec3(1.0), vec3(0.58, 0.56, 0.53), wet);
}
