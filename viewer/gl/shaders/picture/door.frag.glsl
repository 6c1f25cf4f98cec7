// Selects a share of the pixels, evenly spread: interleaved gradient noise (J. Jimenez 2014, "Next generation post
// processing in Call of Duty: Advanced Warfare"), shifted for each number.
uniform float opacity;
uniform float number;
out vec4 color;

void main() {
  vec2 at = floor(gl_FragCoord.xy) + 5.588238 * number;
  float threshold = fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715))));
  if (threshold < opacity) discard;
  color = vec4(0.0);
}
