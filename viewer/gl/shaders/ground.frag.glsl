#include "sward.part.glsl"
// The ground between the blades near by, and the grass itself where blades would be smaller than pixels.
uniform float sunlight;  // 1, and less in a hard shadow
in vec3 place_m;
out vec4 color;

void main() {
  vec3 from_eye = place_m - eye_m.xyz;
  float distance_m = length(from_eye);
  vec3 to_eye = -from_eye / distance_m;
  vec2 at_m = place_m.xz;
  vec2 patch_at = patches(at_m);
  float growth_here = growth_at(at_m).r;
  // While tall grass fades it is on the pixels that its door leaves open (door.frag.glsl).
  float threshold = pixel_chance(floor(gl_FragCoord.xy) + 5.588238 * stand.z);
  float tall = threshold < bend_mean.w ? tall_share(growth_here) : 0.0;

  // Tufts, as large as a few pixels at every distance: two sizes, of which one replaces the other. Of the noise only what
  // is fine, so that its tile is not seen. At flat angles as sharp as half of them allow.
  float size = log2(max(distance_m, 2.0) * 0.035);
  float next = fract(size);
  float per_m = 0.30 * exp2(-floor(size));
  float blur = log2(256.0 * per_m * distance_m * eye_m.w) - 0.5 * log2(max(to_eye.y, 0.02));
  vec2 turned_m = mat2(0.8, 0.6, -0.6, 0.8) * at_m * (0.5 * per_m) + 0.31;
  float fine = textureLod(noise_tile, at_m * per_m, blur).r - textureLod(noise_tile, at_m * per_m, max(blur, 4.0)).r;
  float coarse = textureLod(noise_tile, turned_m, blur - 1.0).r - textureLod(noise_tile, turned_m, max(blur - 1.0, 4.0)).r;
  float tufts = clamp(2.6 * mix(fine, coarse, next), -0.5, 0.5);

  float lit = sunlight * mix(kSunInShadow, 1.0, sunlight_at(place_m, pixel_chance(gl_FragCoord.xy)));
  vec3 canopy = canopy_light(bend_at(at_m, tall), to_eye, patch_at, tufts, tall, lit);

  // Shaded earth and stems.
  vec3 under = mix(vec3(0.040, 0.056, 0.016), vec3(0.100, 0.118, 0.034), 0.5 + tufts);
  vec3 lawn_floor = 0.55 * tint_of(patch_at, 0.4 + tufts);
  vec3 below = mix(lawn_floor * (sky_light.rgb * 0.7 + sun_light.rgb * (0.25 * lit)), under * (sky_light.rgb * 0.8 + sun_light.rgb * (0.13 * lit)), tall);

  float far = mix(smoothstep(1.0, 14.0, distance_m), smoothstep(3.0, 32.0, distance_m), tall);
  vec3 light = mix(below, canopy, far);
  light = mix(vec3(0.07, 0.05, 0.03) * (sky_light.rgb + sun_light.rgb * (0.3 * lit)), light, smoothstep(0.0, 0.1, growth_here));
  light += mix(vec3(0.10, 0.07, 0.045), tint_of(patch_at, 0.5), 0.5 * far * smoothstep(0.0, 0.1, growth_here)) * fire_light(place_m, vec3(0.0, 1.0, 0.0));
  color = vec4(dithered(seen(light, place_m), gl_FragCoord.xy), 1.0);
}
