#include "sky.part.glsl"
#include "heavens.part.glsl"
// The sky.
out vec4 color;

void main() {
  vec3 direction = normalize(ray);
  vec4 sky = sky_in(direction);
  color = vec4(dithered(with_heavens(sky.rgb, direction, sky.a), gl_FragCoord.xy), 1.0);
}
