// The bed of embers under a flame: a level disc.
uniform vec4 disc_m;  // its middle; w: its radius

out vec2 at;

void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  gl_Position = to_clip * vec4(disc_m.xyz + disc_m.w * vec3(at.x, 0.0, at.y), 1.0);
}
