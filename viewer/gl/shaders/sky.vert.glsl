// A coarse grid over the whole picture, behind everything: the air's light changes slowly, so that it is computed at
// the grid's points.
const int kColumns = 40;
const int kRows = 24;  // one instance each

out vec3 ray;
out vec3 clear;    // the screen's value of the clear air
out vec3 shaded;   // of a cloud, away from the sun and toward it
out vec3 sunlit;

void main() {
  vec2 at = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1)) / vec2(kColumns, kRows) * 2.0 - 1.0;
  gl_Position = vec4(at, 1.0, 1.0);
  ray = forward.xyz + right.xyz * (at.x * right.w) + up.xyz * (at.y * up.w);

  vec3 direction = normalize(ray);
  vec3 air = air_light(direction);
  float near_sun = max(dot(direction, sun_disc.xyz), 0.0);
  float near_2 = near_sun * near_sun;
  float far = exp(-14.0 * max(direction.y, 0.0));  // through more and more air toward the horizon
  vec3 cloud = mix(mix(air, cloud_light.rgb, 0.85), air, far);
  clear = finish(air);
  shaded = finish(cloud);
  sunlit = finish(cloud + cloud_glow.rgb * (0.12 + 0.85 * near_2 * near_2 * near_2) * (1.0 - far));
}
