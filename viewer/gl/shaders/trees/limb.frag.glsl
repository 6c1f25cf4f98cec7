// Short hair: streaks along it, a soft outline where it stands against what is behind, and light that comes through there.
uniform sampler2D noise_tile;
uniform bool is_hair;  // one that stands on the skin
in vec3 place_m;
in vec3 normal;
in vec3 tint;
in vec2 hair_m;
out vec4 color;

void main() {
  vec3 from_eye = normalize(place_m - eye_m.xyz);
  vec3 facing = normalize(normal);
  // Locks, and hairs in them, which do not lie quite alike.
  float locks = texture(noise_tile, hair_m * vec2(1.7, 3.1)).r;
  float fine = texture(noise_tile, hair_m * vec2(4.3, 17.0) + vec2(0.37, 0.25 * locks)).r;
  float rim = 1.0 - abs(dot(facing, from_eye));
  // The last hairs of the outline stand apart.
  if (!is_hair && rim > 0.70 + 0.55 * fine) discard;
  vec3 albedo = tint * (0.58 + 0.20 * locks + 0.75 * fine);
  float deep = 1.0 - 0.55 * smoothstep(0.75, 0.30, fine);
  float sun_up = dot(facing, to_sun.xyz);
  vec3 sun = sun_light.rgb * below_clouds(place_m) * mix(0.2, 1.0, sunlight_near(place_m + 0.08 * facing));
  vec3 light = albedo * (soft_light(facing) * deep + sun * smoothstep(-0.25, 1.0, sun_up) * 0.8);
  light += albedo * fire_light(place_m, facing) * deep;
  float against = max(dot(from_eye, to_sun.xyz), 0.0);
  light += albedo * rim * rim * (0.35 * sky_light.rgb + 0.9 * against * against * sun);
  color = vec4(seen(light, place_m), 1.0);
}
