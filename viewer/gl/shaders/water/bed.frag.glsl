#include "sward.part.glsl"
#include "shore.part.glsl"
// The color of a pond's bed, lit from straight above: its square root, which 8 bits hold.
uniform float texel_m;
in vec3 bed_at_m;  // y: above the water
out vec4 color;

void main() {
  float height;
  vec3 earth = earth_at(bed_at_m.xz, bed_at_m.y, texel_m, height);
  color = vec4(sqrt(earth * (0.4 + 0.6 * height)), 1.0);
}
