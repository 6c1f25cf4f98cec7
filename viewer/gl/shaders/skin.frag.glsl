// Pale wool, close to the skin, which is seen where a coat parts.
uniform sampler2D noise_tile;
in vec3 place_m;
in vec3 normal;
out vec4 color;

void main() {
  vec3 facing = normalize(normal);
  vec2 at = place_m.xz + 0.6 * place_m.yy;
  float wool = texture(noise_tile, at * vec2(3.1, 9.7)).r * 0.6 + texture(noise_tile, at * 17.0).r * 0.4;
  vec3 albedo = mix(vec3(0.33, 0.205, 0.115), vec3(0.62, 0.46, 0.30), wool);
  float lit = mix(0.25, 1.0, sunlight_near(place_m + 0.14 * facing)) * smoothstep(-0.1, 0.6, dot(facing, to_sun.xyz));
  // What comes down to it has been coloured by hairs.
  vec3 light = albedo * (vec3(0.95, 0.76, 0.58) * soft_light(facing) + 0.62 * sun_light.rgb * lit);
  light += 0.5 * albedo * fire_light(place_m, facing);
  color = vec4(seen(light, place_m), 1.0);
}
