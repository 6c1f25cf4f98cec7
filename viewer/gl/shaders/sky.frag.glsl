// The sky: air, clouds that drift, sun, moon and stars.
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
out vec4 color;

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

// Stars: one in some of the cells of a grid on a cube around the eye; brighter ones are rarer.
vec3 star_light(vec3 direction) {
  vec3 size = abs(direction);
  vec3 face = size.x > size.y && size.x > size.z ? direction.yzx : (size.y > size.z ? direction.xzy : direction.xyz);
  vec2 at = face.xy / abs(face.z) * 110.0;
  vec2 cell = floor(at);
  vec3 chance = fract(sin(vec3(dot(cell, vec2(12.9898, 78.233)), dot(cell, vec2(39.346, 11.135)), dot(cell, vec2(73.156, 52.235))) +
                          sign(face.z)) * 43758.5453);
  vec2 off = (at - cell - 0.25 - 0.5 * chance.yz) / 110.0 / eye_m.w;  // in pixels
  float bright = max(chance.x - 0.86, 0.0) * 7.0;
  bright *= bright * bright;
  return mix(vec3(1.0, 0.86, 0.70), vec3(0.75, 0.86, 1.0), chance.y) * (bright * max(1.0 - 0.55 * dot(off, off), 0.0));
}

void main() {
  vec3 direction = normalize(ray);
  float height = max(direction.y, 0.0);
  vec4 seen_clouds = clouds_in(direction);
  // Wisps that are finer than the map.
  float fine = texture(noise_tile, (direction.xz / (height + 0.03) - drift.xy) * 2.1).r - 0.5;
  seen_clouds.r = clamp(seen_clouds.r + 2.2 * fine * seen_clouds.r * (1.0 - seen_clouds.r), 0.0, 1.0);
  float cloud = seen_clouds.r * smoothstep(0.0, 0.035, height);
  vec3 value = mix(clear, mix(upper, sunlit, 0.8), 0.55 * seen_clouds.a);
  value = mix(value, mix(mix(base, upper, seen_clouds.b), sunlit, seen_clouds.g), cloud);

  if (air.w > 0.0 && height > 0.0) value += star_light(direction) * (0.75 * air.w * (1.0 - cloud) * smoothstep(0.0, 0.25, height));

  // The moon, twice as large as it is, with the side lit that faces the sun.
  float to_moon = dot(direction, moon_disc.xyz);
  if (moon_disc.w > 0.0 && to_moon > 0.98) {
    const float kRadius = 0.0090;
    vec3 off = (direction - moon_disc.xyz * to_moon) / kRadius;
    float out_2 = dot(off, off);
    vec3 bulge = off - moon_disc.xyz * sqrt(max(1.0 - out_2, 0.0));
    float lit = smoothstep(-0.05, 0.25, dot(bulge, sun_disc.xyz));
    float edge = eye_m.w / kRadius;
    float inside = 1.0 - smoothstep(1.0 - edge, 1.0 + edge, sqrt(out_2));
    float spots = texture(noise_tile, off.xy * 0.07 + 0.2).r;
    float glow = (0.16 * exp(-0.25 * out_2) + 0.05 * exp(-0.02 * out_2)) * step(sun_disc.y, 0.0);
    vec3 moon = vec3(0.66, 0.70, 0.80) * glow + vec3(0.98, 0.96, 0.90) * (lit * inside * (0.70 + 0.40 * spots));
    value += (1.0 - value) * moon * (moon_disc.w * (1.0 - 0.85 * cloud));
  }

  float sun = smoothstep(0.99962, 0.99985, dot(direction, sun_disc.xyz)) * sun_disc.w;
  color = vec4(dithered(mix(value, vec3(1.0, 0.99, 0.93), sun), gl_FragCoord.xy), 1.0);
}
