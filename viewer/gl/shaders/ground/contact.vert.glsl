// The dark ground around a trunk's foot, where little of the sky's light comes: a square on the ground.
uniform vec4 place_to_m;  // the foot; w: scale
uniform float radius_m;   // of the trunk there

out vec2 beside;  // the trunk's middle at 0, the end of the shade at 1
out vec3 place_m;

const float kReach = 6.0;  // of the shade, in radii of the trunk

void main() {
  beside = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  vec2 aside_m = beside * (kReach * radius_m * place_to_m.w);
  place_m = place_to_m.xyz + vec3(aside_m.x, 0.01, aside_m.y);
  gl_Position = to_clip * vec4(place_m, 1.0);
}
