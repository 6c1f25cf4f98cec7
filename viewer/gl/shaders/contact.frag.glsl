// Multiplies what is behind it.
in vec2 beside;
out vec4 color;

void main() {
  float near = max(1.0 - length(beside), 0.0);
  color = vec4(vec3(1.0 - 0.8 * near * near), 1.0);
}
