#include "cloth.part.glsl"
const vec3 kLinen = vec3(0.70, 0.63, 0.51);

// Linen, with broad stripes that hang down where they are wanted. In metres.
vec3 curtain(vec2 at_m) {
  vec3 ground = wanted(color_1, kLinen);
  return mix(ground, color_2.rgb, color_2.w * cover(0.25 - abs(fract(at_m.x / 0.30) - 0.5)));
}

void main() {
  // Hems are folded: more layers, which let less light through.
  vec2 to_end_m = size_m - cloth_m;
  vec2 inside_m = min(cloth_m, to_end_m);
  vec3 seams = max(hem(inside_m.x, cloth_m.y, 0.020), hem(to_end_m.y, cloth_m.x, 0.070));
  seams = max(seams, hem(cloth_m.y, cloth_m.x, 0.055));
  show(Sewn(curtain(cloth_m), seams, 0.62, 0.0, 0.0025, vec2(0.0), 0.11));
}
