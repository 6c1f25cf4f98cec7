// Bark, furrowed along the branch; darker inside the crown.
uniform vec3 crown_middle_m;
uniform vec3 crown_radius_m;

in vec3 place_m;
in vec3 normal;
in vec3 tint;
in vec2 bark_m;
out vec4 color;

void main() {
  vec3 from_eye = normalize(place_m - eye_m.xyz);
  vec3 facing = normalize(normal);
  facing *= dot(facing, from_eye) > 0.0 ? -1.0 : 1.0;

  float wander = 0.012 * sin(9.0 * bark_m.y) + 0.006 * sin(31.0 * bark_m.y + 40.0 * bark_m.x);
  float furrow = sin((bark_m.x + wander) * 150.0) * 0.6 + sin((bark_m.x - 1.7 * wander) * 67.0 + 2.0) * 0.4;
  float fine = clamp(1.5 - fwidth(bark_m.x) * 60.0, 0.0, 1.0);
  vec3 paint = tint * (1.0 + 0.40 * furrow * fine);

  vec3 in_crown = (place_m - crown_middle_m) / crown_radius_m;
  float open = smoothstep(0.35, 1.15, length(in_crown));
  vec3 light = paint * soft_light(facing) * (0.45 + 0.55 * open);
  light += paint * kSunLight * mix(0.15, 1.0, sunlight_near(place_m + 0.35 * to_sun.xyz)) * max(dot(facing, to_sun.xyz), 0.0) * (0.25 + 0.75 * open);
  float rim = 1.0 - abs(dot(facing, from_eye));
  light += 0.05 * rim * rim * rim * kSkyLight * open;
  color = vec4(seen(light, place_m), 1.0);
}
