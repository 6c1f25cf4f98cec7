// The dark ground around a trunk's foot, where little of the sky's light comes: a square on the ground.
layout(location = 0) in vec4 root_base;  // metres; w: radius there

out vec2 beside;  // the trunk's middle at 0, the end of the shade at 1

const float kReach = 6.0;  // of the shade, in radii of the trunk

void main() {
  beside = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  vec2 aside_m = beside * (kReach * root_base.w);
  gl_Position = to_clip * vec4(root_base.x + aside_m.x, root_base.y + 0.01, root_base.z + aside_m.y, 1.0);
}
