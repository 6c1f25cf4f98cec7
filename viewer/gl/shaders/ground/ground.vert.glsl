// A flat sheet around the camera, to the horizon.
out vec3 place_m;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  place_m = vec3(eye_m.x, 0.0, eye_m.z) + vec3(corner.x, 0.0, corner.y) * 1500.0;
  gl_Position = to_clip * vec4(place_m, 1.0);
}
