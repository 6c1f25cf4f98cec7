uniform float brightness;

in vec2 across_along;
in float glow;
out vec4 color;

void main() {
  vec2 near = max(1.0 - across_along * across_along, 0.0);
  color = vec4(finish(vec3(3.2, 0.95, 0.14) * (brightness * glow * near.x * near.y)), 0.0);
}
