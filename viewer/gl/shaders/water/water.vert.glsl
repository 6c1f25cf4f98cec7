// What changes so little from pixel to pixel that the corners of the mesh are enough is computed here.
layout(location = 0) in vec3 rest;     // x, z, metres; the height of the bed
layout(location = 1) in float high_m;

uniform sampler2D slopes;   // as in water.part.glsl
uniform sampler2D noise_tile;
uniform sampler2D memory;   // WaterMemory: how far gusts have woken the water, -1 to 1; the share of foam
uniform vec4 grid_place;    // as in water.part.glsl
uniform vec4 grid_axes;
uniform vec4 streaks;
uniform vec3 lee;           // downwind, over half the pond's length that way; how much is washed to the shore there
uniform vec2 middle_m;      // of the pond

out vec3 place_m;
out float depth_m;
out vec4 water_state;
out vec3 down_light;
out vec3 clear_sky;
out vec4 air_between;
out vec3 fires;

const vec3 kAbsorbed = vec3(1.9, 0.85, 1.25);  // per metre

void main() {
  place_m = vec3(rest.x, high_m, rest.y);
  gl_Position = to_clip * vec4(place_m, 1.0);
  depth_m = max(high_m - rest.z, 0.0);
  down_light = exp(-kAbsorbed * depth_m);
  vec2 uv = mat2(grid_axes.xy, grid_axes.zw) * (rest.xy - grid_place.xy);

  // Where gusts have woken the water is a dark paw among smooth water, which mirrors the sky. It has claws: streaks that
  // run with the wind.
  vec2 remembered = textureLod(memory, uv, 0.0).rg;
  float claws = textureLod(noise_tile, rest.xy * 0.11 - drift.xy * 80.0, 1.0).r;
  float paw = smoothstep(-0.35, 0.55, remembered.x + 1.6 * (claws - 0.5));

  // Foam: what waves that broke have left, and what is washed to the lee shore. It floats, in streaks along the wind.
  vec2 floats_m = rest.xy - streaks.zw;
  vec2 in_wind_m = vec2(dot(floats_m, streaks.xy), dot(floats_m, vec2(-streaks.y, streaks.x)));
  float broad = textureLod(noise_tile, in_wind_m * vec2(0.12, 0.55), 2.0).r;
  float washed = 0.8 * lee.z * smoothstep(0.15, 0.75, dot(rest.xy - middle_m, lee.xy)) * (1.0 - smoothstep(0.02, 0.16, depth_m));
  float foamy = max(0.88 * smoothstep(0.0, 0.24, remembered.y), washed);
  float foam = 0.55 * broad - 1.0 + 0.66 * foamy;

  water_state = vec4(paw, foam, textureLod(slopes, uv, 3.6).b, below_clouds(place_m));
  vec3 ray = place_m - eye_m.xyz;
  float distance_m = length(ray);
  clear_sky = finish(air_light(vec3(ray.x, abs(ray.y), ray.z) / distance_m));
  float hidden = haze(distance_m);
  air_between = vec4(hidden * air_light(vec3(ray.x / distance_m, 0.02, ray.z / distance_m)), 1.0 - hidden);
  fires = fire_light(place_m, vec3(0.0, 1.0, 0.0));
}
