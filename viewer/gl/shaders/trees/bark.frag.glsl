#include "grain.part.glsl"
// Bark: plates between furrows that run along the branch and meet; darker inside the crown.
uniform vec3 crown_middle_m;
uniform vec3 crown_radius_m;
uniform float leafy;  // how many leaves there are around, 0 to 1

in vec3 place_m;
in vec3 normal;
in vec3 tint;
in vec2 bark_m;
in float above_foot_m;
out vec4 color;

void main() {
  vec3 from_eye = normalize(place_m - eye_m.xyz);
  vec3 facing = normalize(normal);
  facing *= dot(facing, from_eye) > 0.0 ? -1.0 : 1.0;

  // What is finer than a pixel fades out.
  float pixel_m = fwidth(bark_m.x) + fwidth(bark_m.y);
  vec2 drawn_out = vec2(1.0, 0.11) * bark_m;
  float plates = abs(grain(drawn_out * 38.0) + 0.6 * grain(drawn_out * 97.0 + 7.0) - 0.8);
  float furrow = mix(0.55, smoothstep(-0.05, 0.42, plates), clamp(1.4 - pixel_m * 25.0, 0.0, 1.0));
  float fine = mix(0.5, grain(bark_m * vec2(260.0, 90.0)), clamp(1.4 - pixel_m * 150.0, 0.0, 1.0));
  float patches = grain(bark_m * vec2(5.0, 2.2));
  vec3 paint = tint * (0.40 + 0.80 * furrow) * (0.75 + 0.5 * fine) * (0.75 + 0.5 * patches);
  paint += vec3(0.020, 0.024, 0.016) * smoothstep(0.62, 0.85, patches) * furrow;  // lichen
  // Moss at the foot, higher up on the side that faces north; and earth where the trunk meets the ground.
  float moss = smoothstep(0.42, 0.75, patches + 0.25 * furrow - 0.9 * above_foot_m - 0.22 * facing.z);
  paint = mix(paint, vec3(0.030, 0.050, 0.014) * (0.6 + 0.8 * fine), 0.8 * moss);
  paint *= mix(0.45, 1.0, smoothstep(0.0, 0.22, above_foot_m));

  vec3 in_crown = (place_m - crown_middle_m) / crown_radius_m;
  float open = mix(1.0, smoothstep(0.35, 1.15, length(in_crown)), 0.2 + 0.8 * leafy);
  vec3 light = paint * soft_light(facing) * (0.45 + 0.55 * open);
  light += paint * sun_light.rgb * below_clouds(place_m) * mix(0.15, 1.0, sunlight_near(place_m + 0.35 * to_sun.xyz)) * max(dot(facing, to_sun.xyz), 0.0) * (0.25 + 0.75 * open);
  light += paint * fire_light(place_m, facing);
  float rim = 1.0 - abs(dot(facing, from_eye));
  light += 0.05 * rim * rim * rim * sky_light.rgb * open;
  color = vec4(seen(light, place_m), 1.0);
}
