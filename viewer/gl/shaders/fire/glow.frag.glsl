uniform vec4 ball_m;
uniform vec3 light;

in vec2 at;
in float height_m;
out vec4 color;

void main() {
  float near = max(1.0 - length(at), 0.0);
  float over_ground = smoothstep(0.0, 0.5 * ball_m.w, height_m);
  color = vec4(finish(light * (near * near * near * over_ground)), 0.0);
}
