#include "grain.part.glsl"
#include "wood.part.glsl"
// Wood, stone and metal, lit by sun and sky, with a soft highlight.
in vec3 place_m;
in vec3 normal;
in vec3 tint;
in vec3 grained;  // place along and across the grain, metres; how much of it
out vec4 color;

void main() {
  vec3 from_eye = normalize(place_m - eye_m.xyz);
  vec3 facing = normalize(normal);
  facing *= dot(facing, from_eye) > 0.0 ? -1.0 : 1.0;
  vec3 paint = mix(tint, wood(tint, grained.xy), grained.z);
  vec3 sun = sun_light.rgb * below_clouds(place_m) * mix(0.1, 1.0, sunlight_near(place_m + 0.06 * to_sun.xyz));
  vec3 light = paint * (soft_light(facing) + 0.85 * sun * max(dot(facing, to_sun.xyz), 0.0));
  light += paint * fire_light(place_m, facing);
  float shine = max(dot(facing, normalize(to_sun.xyz - from_eye)), 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  float rim = 1.0 - abs(dot(facing, from_eye));
  light += (0.06 * shine * shine * sun + 0.10 * rim * rim * rim * sky_light.rgb) * (0.3 + tint);
  color = vec4(seen(light, place_m), 1.0);
}
