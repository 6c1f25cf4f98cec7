// Short turf to the horizon; under a meadow, shaded earth and stems.
uniform sampler2D noise_tile;
uniform float sunlight;  // 1, and less in a shadow
in vec3 place_m;
out vec4 color;

const float kSunInShadow = 0.16;  // leaves, threads and the air let some through

void main() {
  vec3 from_eye = place_m - eye_m.xyz;
  float distance_m = length(from_eye);
  float broad = texture(noise_tile, place_m.xz * 0.023).r;
  float fine = texture(noise_tile, mat2(0.8, 0.6, -0.6, 0.8) * place_m.xz * 0.13 + 0.73).r;

  // The distance inside the field, with a ragged edge.
  vec2 inside = min(place_m.xz - field.xy, field.zw - place_m.xz);
  float in_field = smoothstep(-0.5, 0.3, min(inside.x, inside.y) + 0.8 * (fine - 0.5));

  vec3 turf = mix(vec3(0.070, 0.122, 0.028), vec3(0.138, 0.158, 0.042), smoothstep(0.25, 0.8, broad));
  float tufts = texture(noise_tile, mat2(0.28, 0.96, -0.96, 0.28) * place_m.xz * 0.43 + 0.31).r;
  float blades = texture(noise_tile, mat2(0.6, 0.8, -0.8, 0.6) * place_m.xz * 1.9).r;
  turf *= 0.62 + 0.65 * fine;
  turf *= 0.66 + 0.42 * tufts + 0.26 * blades;
  vec3 under = mix(vec3(0.020, 0.030, 0.009), vec3(0.060, 0.070, 0.020), fine);

  // Toward the low sun the light shines through the turf's blades.
  vec3 direction = from_eye / distance_m;
  float against = max(dot(direction, to_sun.xyz), 0.0);
  vec3 sun = kSunLight * sunlight * mix(kSunInShadow, 1.0, sunlight_at(place_m, pixel_chance(gl_FragCoord.xy)));
  vec3 light = mix(turf * (kSkyLight * 0.8 + sun * (0.30 + 0.55 * against * against)),
                   under * (kSkyLight * 0.8 + sun * 0.10), in_field);
  color = vec4(dithered(seen(light, place_m), gl_FragCoord.xy), 1.0);
}
