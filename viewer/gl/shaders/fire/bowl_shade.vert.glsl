// The shadow of a fire bowl in the light of its own fire: a square on the ground.
uniform vec4 shade_m;  // its middle, east and south; how far it is full, and where it ends

out vec2 beside_m;
out vec3 place_m;

void main() {
  beside_m = (vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0) * shade_m.w;
  place_m = vec3(shade_m.x + beside_m.x, 0.012, shade_m.y + beside_m.y);
  gl_Position = to_clip * vec4(place_m, 1.0);
}
