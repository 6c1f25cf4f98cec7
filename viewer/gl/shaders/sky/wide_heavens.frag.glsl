#include "heavens.part.glsl"
// The same where sun, moon or stars are in view.
uniform sampler2D small_sky;
uniform vec2 pixel;
in vec3 ray;
out vec4 color;

void main() {
  vec4 sky = textureLod(small_sky, gl_FragCoord.xy * pixel, 0.0);
  color = vec4(dithered(with_heavens(sky.rgb, normalize(ray), sky.a), gl_FragCoord.xy), 1.0);
}
