// Multiplies what is behind it, less the more of that is air.
in vec2 beside;
in vec3 place_m;
out vec4 color;

void main() {
  float near = max(1.0 - length(beside), 0.0);
  color = vec4(vec3(1.0 - 0.8 * near * near * (1.0 - haze(distance(eye_m.xyz, place_m)))), 1.0);
}
