// A coarse grid over the whole picture, behind everything: the air's light changes slowly, so that it is computed at
// the grid's points.
const int kColumns = 40;
const int kRows = 24;  // one instance each

out vec3 ray;
out vec3 clear;    // the screen's value of the clear air
out vec3 base;     // of a cloud: its shaded base, its upper side by the sky's light, and in the sun
out vec3 upper;
out vec3 sunlit;

void main() {
  vec2 at = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1)) / vec2(kColumns, kRows) * 2.0 - 1.0;
  gl_Position = vec4(at, 1.0, 1.0);
  ray = forward.xyz + right.xyz * (at.x * right.w) + up.xyz * (at.y * up.w);

  vec3 direction = normalize(ray);
  vec3 air = air_light(direction);
  // By night the moon lights them.
  float near_sun = max(dot(direction, sun_disc.y > -0.12 ? sun_disc.xyz : to_sun.xyz), 0.0);
  float near_2 = near_sun * near_sun;
  float far = exp(-14.0 * max(direction.y, 0.0));  // through more and more air toward the horizon
  clear = finish(air);
  vec3 glow = cloud_glow.rgb * (0.55 + 1.6 * near_2 * near_2 * near_2);
  base = finish(mix(0.50 * cloud_light.rgb, air, far));
  upper = finish(mix(0.85 * cloud_light.rgb, air, far));
  sunlit = finish(mix(0.95 * cloud_light.rgb + glow, air + 0.25 * glow, far));
}
