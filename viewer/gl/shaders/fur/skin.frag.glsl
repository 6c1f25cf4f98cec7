// Pale wool, close to the skin, which is seen where a coat parts.
uniform sampler2D noise_tile;
in vec3 place_m;
in vec3 normal;
out vec4 color;

void main() {
  vec3 facing = normalize(normal);
  vec2 at = place_m.xz + 0.6 * place_m.yy;
  float wool = texture(noise_tile, at * vec2(3.1, 9.7)).r * 0.6 + texture(noise_tile, at * 17.0).r * 0.4;
  vec3 albedo = mix(vec3(0.34, 0.215, 0.120), vec3(0.54, 0.385, 0.240), wool);
  float lit = below_clouds(place_m) * mix(0.25, 1.0, sunlight_near(place_m + 0.14 * facing)) * smoothstep(-0.1, 0.6, dot(facing, to_sun.xyz));
  // What comes down to it has been dimmed and coloured by hairs, as at their roots.
  vec3 light = albedo * (vec3(0.42, 0.32, 0.23) * soft_light(facing) + vec3(0.28, 0.25, 0.21) * sun_light.rgb * lit);
  light += 0.5 * albedo * fire_light(place_m, facing);
  color = vec4(seen(light, place_m), 1.0);
}
