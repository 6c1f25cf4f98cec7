// Water: the sky and the far hills in it, reflected more at flat angles (Schlick 1994, "An inexpensive BRDF model for
// physically-based rendering"); the water's own green at steep ones.
in vec3 place_m;
in vec3 normal;
out vec4 color;

void main() {
  vec3 from_eye = normalize(place_m - eye_m.xyz);
  vec3 up_facing = normalize(normal);
  up_facing *= up_facing.y < 0.0 ? -1.0 : 1.0;
  float cosine = clamp(-dot(up_facing, from_eye), 0.0, 1.0);
  float missing = 1.0 - cosine;
  float missing_2 = missing * missing;
  float mirrored = 0.02 + 0.98 * missing_2 * missing_2 * missing;

  vec3 up_ray = reflect(from_eye, up_facing);
  up_ray.y = abs(up_ray.y);
  vec3 sky = air_light(up_ray);
  vec3 hills = mix(air_light(normalize(vec3(up_ray.x, 0.02, up_ray.z))), vec3(0.087, 0.113, 0.074) * sky_light.rgb, 0.70);
  sky = mix(hills, sky, smoothstep(0.0, 0.11, up_ray.y));
  float glint = max(dot(up_ray, to_sun.xyz), 0.0);
  glint = pow(glint, 200.0);

  // Light scattered in the water: more where a wave's slope faces the sun.
  float sun = max(dot(up_facing, to_sun.xyz), 0.0);
  float against = max(dot(from_eye, to_sun.xyz), 0.0);
  vec3 within = vec3(0.022, 0.073, 0.057) * sky_light.rgb + vec3(0.003, 0.020, 0.026) * sun_light.rgb * (sun + 0.7 * against * missing);
  vec3 light = mix(within, sky, mirrored) + sun_light.rgb * 1.3 * glint;
  light += mirrored * fire_mirrored(place_m, up_ray) + (1.0 - mirrored) * vec3(0.022, 0.073, 0.057) * fire_light(place_m, up_facing);
  color = vec4(seen(light, place_m), 1.0);
}
