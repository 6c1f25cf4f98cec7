#include "sward.part.glsl"
#include "shore.part.glsl"
// The bank of a pond: earth and stones, wet at the water, with moss and turf at its upper edge.
uniform float water_m;  // the water's height
in vec3 place_m;
in vec3 normal;
in float edge;
out vec4 color;

void main() {
  float above_m = place_m.y - water_m;
  float height;
  vec3 albedo = earth_at(place_m.xz, above_m, eye_m.w * distance(eye_m.xyz, place_m), height);
  float turf = smoothstep(0.25, 0.75, edge + 0.55 * (texture(noise_tile, place_m.xz * 0.7).r - 0.5));
  albedo = mix(albedo, vec3(0.075, 0.092, 0.030) * (0.5 + texture(noise_tile, place_m.xz * 2.1).r), turf);

  vec3 bumped = normalize(normal + 0.030 * (dFdx(height) * right.xyz + dFdy(height) * up.xyz) / max(eye_m.w * distance(eye_m.xyz, place_m) * 8.0, 0.01));
  float lit = below_clouds(place_m) * mix(0.12, 1.0, sunlight_at(place_m + 0.02 * normal, pixel_chance(gl_FragCoord.xy)));
  vec3 light = albedo * (soft_light(bumped) * (0.55 + 0.45 * smoothstep(0.0, 0.7, height)) + 0.9 * lit * sun_light.rgb * max(dot(bumped, to_sun.xyz), 0.0));
  light += albedo * fire_light(place_m, bumped);
  // The water's film shines.
  float wet = 1.0 - smoothstep(0.0, 0.03, above_m);
  vec3 from_eye = normalize(place_m - eye_m.xyz);
  float missing = 1.0 - max(-dot(from_eye, normal), 0.0);
  light += 0.35 * wet * missing * missing * missing * air_light(reflect(from_eye, normal));
  color = vec4(seen(light, place_m), 1.0);
}
