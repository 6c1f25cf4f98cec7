#include "cloth.part.glsl"
const vec3 kInk = vec3(0.020, 0.060, 0.235);
const vec3 kVermilion = vec3(0.60, 0.062, 0.022);
const vec3 kSnow = vec3(0.76, 0.74, 0.68);

// White, with a red head, a crest of three gusts, and a dark blue foot of waves. Unit: the banner's width.
vec3 banner(vec2 p, float tall) {
  vec3 ground = wanted(color_1, kSnow);
  if (is_plain()) return ground;
  vec3 ink = wanted(color_2, kInk);
  vec3 red = wanted(color_2, kVermilion);
  vec3 paint = ground;
  paint = mix(paint, red, cover(0.36 - p.y));
  paint = mix(paint, ground, cover(0.022 - abs(p.y - 0.29)));

  vec2 from_crest = p - vec2(0.5, 0.92);
  float radius = length(from_crest);
  float turn = atan(from_crest.y, from_crest.x);
  float gusts = sin(3.0 * turn - 15.0 * radius);
  paint = mix(paint, ink, cover(0.355 - radius));
  paint = mix(paint, ground, cover(0.30 - radius) * cover(gusts * (0.12 + radius)));
  paint = mix(paint, red, cover(0.055 - radius));

  for (int i = 0; i < 3; ++i) {
    float n = float(i);
    float foot = tall - 1.15 + 0.30 * n + 0.055 * sin(6.2832 * (p.x * 1.5 + 0.31 * n));
    paint = mix(paint, i == 1 ? ground : ink, cover(p.y - foot));
  }
  float stem = 0.030 * smoothstep(1.36, 2.1, p.y) * smoothstep(tall - 1.34, tall - 1.9, p.y);
  float thread = stem - abs(p.x - 0.5 - 0.11 * sin(2.6 * p.y + 0.6));
  paint = mix(paint, red, cover(thread) * step(1.36, p.y) * step(p.y, tall - 1.34));
  return paint;
}

void main() {
  // Hems are folded: more layers, which let less light through.
  vec2 to_end_m = size_m - cloth_m;
  vec2 inside_m = min(cloth_m, to_end_m);
  vec3 seams = max(hem(inside_m.x, cloth_m.y, 0.012), hem(inside_m.y, cloth_m.x, 0.014));
  show(Sewn(banner(cloth_m / size_m.x, size_m.y / size_m.x), seams, 0.56, 0.4, 0.0015, vec2(0.0), 0.13));
}
