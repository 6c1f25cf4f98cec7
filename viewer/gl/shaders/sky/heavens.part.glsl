// Sun, moon and stars, which are too sharp for a smaller picture of the sky.
uniform sampler2D moon_spots;

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

// The screen's value of the sky, with them.
vec3 with_heavens(vec3 value, vec3 direction, float cloud) {
  float height = max(direction.y, 0.0);
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
    float spots = texture(moon_spots, off.xy * 0.07 + 0.2).r;
    float glow = (0.16 * exp(-0.25 * out_2) + 0.05 * exp(-0.02 * out_2)) * step(sun_disc.y, 0.0);
    vec3 moon = vec3(0.66, 0.70, 0.80) * glow + vec3(0.98, 0.96, 0.90) * (lit * inside * (0.70 + 0.40 * spots));
    value += (1.0 - value) * moon * (moon_disc.w * (1.0 - 0.85 * cloud));
  }

  return mix(value, vec3(1.0, 0.99, 0.93), smoothstep(0.99962, 0.99985, dot(direction, sun_disc.xyz)) * sun_disc.w);
}
