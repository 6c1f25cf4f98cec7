// Woods and slopes far away: lit by the sun and the sky, and seen through much air.
uniform sampler2D relief_tile;  // gl::make_relief_texture()
uniform int range;
in vec3 place_m;
in vec2 wall_m;
in float top_m;
in vec3 air_there;
in vec3 hazed;
out vec4 color;

void main() {
  vec3 ray = normalize(place_m - eye_m.xyz);
  bool is_wood = range < 2;

  // Crowns and slopes bulge toward the eye and up, unevenly.
  float grain_m = is_wood ? 26.0 : range == 2 ? 260.0 : range == 3 ? 1400.0 : 5200.0;
  vec2 at = wall_m * vec2(1.0, is_wood ? 1.3 : 2.4) / grain_m;
  vec3 relief = texture(relief_tile, at).rgb - 0.5;
  float bumps = relief.r;
  vec3 aside = normalize(vec3(-ray.z, 0.0, ray.x));
  vec3 normal = normalize(vec3(-ray.x, is_wood ? 0.5 : 0.9, -ray.z) - aside * ((is_wood ? 5.0 : 2.5) * relief.g) +
                          vec3(0.0, 1.0, 0.0) * (-4.0 * relief.b));

  float up = clamp(wall_m.y / top_m, 0.0, 1.0);
  float open = is_wood ? (0.35 + 0.65 * up) * (0.75 + 0.9 * bumps) : 0.85 + 0.4 * bumps;  // to the sky
  vec3 paint = range < 3 ? mix(vec3(0.030, 0.050, 0.017), vec3(0.062, 0.082, 0.024), 0.5 + bumps) : vec3(0.060, 0.075, 0.050);
  paint *= mix(vec3(1.0), woods.rgb, range < 3 ? 1.0 : 0.2);  // hardly any on mountains
  if (range >= 2) paint = mix(paint, vec3(0.66, 0.71, 0.78), woods.w * smoothstep(-0.25, 0.15, bumps + 0.35 * (float(range) - 2.6)));
  vec3 light = paint * (soft_light(normal) * open + sun_light.rgb * max(dot(normal, to_sun.xyz), 0.0) * mix(1.0, open, 0.5));
  // Against the sun thin crowns glow.
  float against = max(dot(ray, to_sun.xyz), 0.0);
  if (is_wood) light += paint * vec3(1.2, 1.1, 0.5) * sun_light.rgb * (0.22 * against * against * up);

  color = vec4(dithered(finish(mix(light, air_there, hazed)), gl_FragCoord.xy), 1.0);
}
