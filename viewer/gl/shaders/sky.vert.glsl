// A coarse grid over the whole picture, behind everything: the air's light changes slowly, so that it is computed at
// the grid's points.
const int kColumns = 40;
const int kRows = 24;  // one instance each

out vec3 ray;
out float ray_length;
out vec3 clear;   // the screen's value of the clear air, and of a cloud
out vec3 clouded;

void main() {
  vec2 at = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1)) / vec2(kColumns, kRows) * 2.0 - 1.0;
  gl_Position = vec4(at, 1.0, 1.0);
  ray = forward.xyz + right.xyz * (at.x * right.w) + up.xyz * (at.y * up.w);
  ray_length = length(ray);

  vec3 direction = ray / ray_length;
  vec3 air = air_light(direction);
  float near_sun = max(dot(direction, to_sun.xyz), 0.0);
  float near_2 = near_sun * near_sun;
  clear = finish(air);
  clouded = finish(mix(air, vec3(0.72, 0.56, 0.53) + vec3(1.1, 0.52, 0.16) * near_2 * near_2 * near_2, 0.85));
}
