#include "cloth.part.glsl"
const vec3 kInk = vec3(0.020, 0.060, 0.235);
const vec3 kGold = vec3(0.86, 0.44, 0.050);
const vec3 kSnow = vec3(0.76, 0.74, 0.68);
const vec3 kCanvas = vec3(0.66, 0.62, 0.53);

// A golden sun behind three gusts on a dark blue sky. Unit: the flag's height.
vec3 flag(vec2 p, float aspect) {
  vec3 sky = wanted(color_1, kInk);
  if (is_plain()) return sky;
  vec3 sun = wanted(color_2, kGold);
  vec3 gusts = wanted(color_2, kSnow);
  vec3 paint = mix(sky * 1.15, sky * 0.85, p.y);
  paint = mix(paint, sun, cover(0.235 - length(p - vec2(0.40 * aspect, 0.45))));
  for (int i = 0; i < 3; ++i) {
    float n = float(i);
    float swing = 0.065 * sin(4.6 * p.x / aspect * 1.35 + 1.1 * n + 0.4) + 0.018 * sin(11.0 * p.x / aspect + 2.0 * n);
    float along = clamp(p.x / aspect, 0.0, 1.0);
    float begins = 0.10 + 0.07 * n;
    float half_width = (0.034 - 0.006 * n) * smoothstep(begins, begins + 0.35, along) * smoothstep(1.0, 0.72 - 0.08 * n, along);
    float line = half_width - abs(p.y - (0.545 + 0.125 * n + swing));
    paint = mix(paint, gusts, cover(line) * step(0.0005, half_width));
  }
  return paint;
}

// A brass eyelet in its middle: 1 on its ring (x), 1 in its hole (y).
vec2 eyelet(vec2 from_middle_m) {
  float radius_m = length(from_middle_m);
  return vec2(cover(0.0125 - radius_m), cover(0.0060 - radius_m));
}

void main() {
  // Hems are folded: more layers, which let less light through.
  vec2 to_end_m = size_m - cloth_m;
  vec2 inside_m = min(cloth_m, to_end_m);
  vec3 seams = max(hem(inside_m.y, cloth_m.x, 0.014), hem(to_end_m.x, cloth_m.y, 0.026));
  seams.y = max(seams.y, hem(to_end_m.x, cloth_m.y, 0.015).y);
  vec3 paint = flag(cloth_m / size_m.y, size_m.x / size_m.y);
  // A heading of canvas along the hoist, with eyelets in its ends.
  float heading_m = 0.075 * min(size_m.y, 1.4);
  if (!has_picture) paint = mix(paint, kCanvas, cover(heading_m - cloth_m.x));
  seams = max(seams, hem(cloth_m.x, cloth_m.y, heading_m));
  vec2 brass = eyelet(vec2(cloth_m.x - 0.75 * heading_m, inside_m.y - 0.035));
  show(Sewn(paint, seams, 0.50, 1.0, 0.0015, brass, 0.13));
}
