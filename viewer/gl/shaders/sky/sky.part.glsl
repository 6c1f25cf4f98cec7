// The air and the clouds, which drift, in the direction of a pixel.
uniform sampler2D noise_tile;
uniform sampler2D clouds_from;  // maps of clouds (clouds.frag.glsl), the second with this share
uniform sampler2D clouds_to;
uniform float clouds_share;
uniform vec2 drifted_from;      // how far the clouds have drifted since
uniform vec2 drifted_to;
in vec3 ray;
in vec3 clear;
in vec3 base;
in vec3 upper;
in vec3 sunlit;

// What the maps show of the clouds that one sees in a direction now: they have drifted.
vec4 clouds_in(vec3 direction) {
  float height = max(direction.y, 0.0);
  vec3 then = normalize(vec3(direction.x - drifted_to.x * (height + 0.03), height, direction.z - drifted_to.y * (height + 0.03)));
  vec2 at = vec2(atan(then.x, -then.z), then.y);
  vec2 to_other = (drifted_to - drifted_from) * (height + 0.03);  // so small that its slope will do
  vec2 other = at + vec2(dot(vec2(-then.z, then.x), to_other), -then.y * dot(then.xz, to_other));
  return mix(textureLod(clouds_from, vec2(other.x / 6.2831853, sqrt(max(other.y, 0.0))), 0.0),
             textureLod(clouds_to, vec2(at.x / 6.2831853, sqrt(at.y)), 0.0), clouds_share);
}

// The screen's value, and how much clouds cover.
vec4 sky_in(vec3 direction) {
  float height = max(direction.y, 0.0);
  vec4 seen_clouds = clouds_in(direction);
  // Wisps that are finer than the map.
  float fine = texture(noise_tile, (direction.xz / (height + 0.03) - drift.xy) * 2.1).r - 0.5;
  seen_clouds.r = clamp(seen_clouds.r + 2.2 * fine * seen_clouds.r * (1.0 - seen_clouds.r), 0.0, 1.0);
  float cloud = seen_clouds.r * smoothstep(0.0, 0.035, height);
  vec3 value = mix(clear, mix(upper, sunlit, 0.8), 0.55 * seen_clouds.a);
  value = mix(value, mix(mix(base, upper, seen_clouds.b), sunlit, seen_clouds.g), cloud);
  return vec4(value, cloud);
}
