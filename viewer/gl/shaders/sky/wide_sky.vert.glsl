// One triangle behind everything.
out vec3 ray;

void main() {
  vec2 at = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
  gl_Position = vec4(at, 1.0, 1.0);
  ray = forward.xyz + right.xyz * (at.x * right.w) + up.xyz * (at.y * up.w);
}
