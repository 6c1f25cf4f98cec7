// The glow around a flame: a disc that faces the eye.
uniform vec4 ball_m;  // its middle; w: its radius

out vec2 at;
out float height_m;

void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 place = ball_m.xyz + ball_m.w * (right.xyz * at.x + up.xyz * at.y);
  height_m = place.y;
  gl_Position = to_clip * vec4(place, 1.0);
}
