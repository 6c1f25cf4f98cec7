// Noise of wood and bark, from a place alone: the same from picture to picture.

// From 0 to 1, at the points of a grid.
float lattice(ivec2 at) {
  uint v = uint(at.x) * 1597334677u ^ uint(at.y) * 3812015801u;
  v = (v ^ (v >> 15u)) * 2246822519u;
  return float(v >> 8u) / 16777216.0;
}

// Noise from 0 to 1 between the points of a grid.
float grain(vec2 at) {
  ivec2 cell = ivec2(floor(at));
  vec2 part = fract(at);
  part *= part * (3.0 - 2.0 * part);
  float low = mix(lattice(cell), lattice(cell + ivec2(1, 0)), part.x);
  return mix(low, mix(lattice(cell + ivec2(0, 1)), lattice(cell + 1), part.x), part.y);
}
