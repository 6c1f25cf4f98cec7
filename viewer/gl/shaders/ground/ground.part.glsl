// The ground between the blades near by, and the grass itself where blades would be smaller than pixels.
uniform int images;              // 1: a picture lies on the ground, 0: none
uniform sampler2D ground_image;
uniform vec2 image_form;         // how much of it is seen; its height, in widths of it
in vec3 place_m;
out vec4 color;

float sun_on_ground(vec3 place_m);

// Where no blades are drawn any more, tufts stand in rows across one axis of the world, as on upright cards (R. Habel 2007,
// "Instant animated grass"). Returns how the tuft that one sees differs from its neighbours, about from -0.5 to 0.5. `at_m`: across
// the rows, and along them; `to_eye`: a direction in the same axes and upright; rows are so far apart, tufts so many a metre.
float tufts_in_rows(vec2 at_m, vec3 to_eye, float height_m, float row_m, float tufts_per_m, float wander) {
  float row = at_m.x / row_m + wander + 0.10 * sin(0.11 * tufts_per_m * at_m.y) + 0.14 * sin(0.043 * tufts_per_m * at_m.y + 2.0);
  float toward = to_eye.x < 0.0 ? -1.0 : 1.0;
  float rows = toward > 0.0 ? 1.0 - fract(row) : fract(row);  // to the next row toward the eye
  float per_row_m = row_m / max(abs(to_eye.x), 1e-3);         // of the way to the eye
  float beside_m = at_m.y + rows * per_row_m * to_eye.y;
  float number = floor(row) + (toward > 0.0 ? 1.0 : 0.0);
  vec4 tuft = textureLod(turf_tile, vec2(beside_m * tufts_per_m * (1.0 / 36.0), 0.3711 * number), 0.0);
  float part = rows * per_row_m * to_eye.z / (height_m * clamp(1.2 + 3.0 * (tuft.g - 0.5), 0.4, 2.0));
  float own = 2.6 * (tuft.b - 0.5);
  return mix(0.40 * min(part, 1.0) - 0.19, -0.07, smoothstep(0.95, 1.1, part)) + own;
}

// The same for all directions: more of the rows that one looks across. 0 if the share of it that is to be seen is 0: its loop is
// not run then, while both sides of a branch would be.
float upright_tufts(vec2 at_m, vec3 to_eye, float distance_m, float wander, float seen_share) {
  const float kPixels = 2.0;  // a tuft is about so wide
  float height_m = 0.45 * stand.x;
  float level = log2(max(distance_m, 1.0));
  // Powers of two of both, so that tufts stay in their places while the eye moves.
  float row_at_1m = exp2(floor(log2(height_m / max(abs(eye_m.y), 0.2)) + 0.5));
  float tufts_at_1m = exp2(-floor(log2(kPixels * eye_m.w) + 0.5));
  vec2 level_way = normalize(to_eye.xz);
  float rise = to_eye.y / length(to_eye.xz);
  float across_x = level_way.x * level_way.x;
  across_x = smoothstep(0.3, 0.7, across_x);
  float sum = 0.0;
  int levels = seen_share > 0.0 ? 2 : 0;
  for (int i = 0; i < levels; ++i) {
    float size = exp2(floor(level) + float(i));
    float share = i == 0 ? 1.0 - fract(level) : fract(level);
    float here = 0.0;
    if (across_x > 0.0) here += across_x * tufts_in_rows(at_m, vec3(level_way, rise), height_m, row_at_1m * size, tufts_at_1m / size, wander);
    if (across_x < 1.0) here += (1.0 - across_x) * tufts_in_rows(at_m.yx, vec3(level_way.yx, rise), height_m, row_at_1m * size, tufts_at_1m / size, wander);
    sum += share * here;
  }
  return sum;
}

void main() {
  vec3 from_eye = place_m - eye_m.xyz;
  float distance_m = length(from_eye);
  vec3 to_eye = -from_eye / distance_m;
  vec2 at_m = place_m.xz;
  vec2 patch_at = patches(at_m, log2(256.0 * 0.0061 * distance_m * eye_m.w));
  float growth_here = growth_at(at_m).r;
  // While tall grass fades it is on the pixels that its door leaves open (door.frag.glsl).
  float threshold = pixel_chance(floor(gl_FragCoord.xy) + 5.588238 * stand.z);
  float tall = threshold < bend_mean.w ? tall_share(growth_here) : 0.0;

  // Tufts, as large as a few pixels at every distance: two sizes, of which one replaces the other. At flat angles as sharp
  // as half of them allow.
  float size = log2(max(distance_m, 2.0) * 0.035);
  float next = fract(size);
  float per_m = 0.30 * exp2(-floor(size));
  float blur = log2(256.0 * per_m * distance_m * eye_m.w) - 0.5 * log2(max(to_eye.y, 0.02));
  vec2 turned_m = mat2(0.8, 0.6, -0.6, 0.8) * at_m * (0.5 * per_m) + 0.31;
  float fine = textureLod(turf_tile, at_m * per_m, blur).b - 0.5;
  float coarse = textureLod(turf_tile, turned_m, blur - 1.0).b - 0.5;
  float tufts = clamp(3.2 * mix(fine, coarse, next) + clumps_at(at_m, blur - log2(256.0 * per_m)), -0.5, 0.5);

  // Beyond the blades, at a flat angle, as long as they are higher than a pixel.
  float upright = tall * smoothstep(14.0, 34.0, distance_m) * (1.0 - smoothstep(0.10, 0.30, to_eye.y)) * smoothstep(0.5, 2.0, 0.45 * stand.x / (distance_m * eye_m.w));
  tufts = clamp(tufts * (1.0 - 0.8 * upright) + upright * upright_tufts(at_m, to_eye, distance_m, 4.0 * (patch_at.x + patch_at.y), upright), -0.7, 0.7);

  float lit = mix(kSunInShadow, 1.0, sun_on_ground(place_m));
  lit *= under_clouds(at_m, distance_m * eye_m.w * inversesqrt(max(to_eye.y, 0.02)));
  vec3 canopy = canopy_light(bend_at(at_m), to_eye, patch_at, tufts, tall, lit);

  // Shaded earth and stems. Seen from above, where a high sun shines between the blades, they are lit.
  float into = 0.13 + 0.25 * max(to_sun.y, 0.0) * to_eye.y * to_eye.y;
  vec3 under = mix(1.2 * grass_foot.rgb, 0.22 * grass_straw.rgb + 0.30 * grass_fresh.rgb, 0.5 + tufts);
  vec3 lawn_floor = 0.55 * tint_of(patch_at, 0.4 + tufts);
  vec3 below = mix(lawn_floor * (sky_light.rgb * 0.7 + sun_light.rgb * (0.25 * lit)), under * (sky_light.rgb * 0.8 + sun_light.rgb * (into * lit)), tall);

  float far = mix(lawn_far(distance_m), smoothstep(3.0, 32.0, distance_m), tall);
  vec3 light = mix(below, canopy, far);

  // Where nothing grows: what is uneven faces the sun or turns away from it.
  // A picture is in place of it; a loop is not run where there is none.
  vec3 soil = earth.rgb;
  float relief = earth.w;
  for (int i = 0; i < images; ++i) {
    vec3 image = texture(ground_image, at_m * grass_foot.w * vec2(1.0, 1.0 / image_form.y) + 0.5).rgb;
    soil = mix(soil, 0.012 + 0.768 * image, image_form.x);  // nothing is quite black, nor reflects all (cloth_renderer.cpp)
    relief *= 1.0 - 0.9 * image_form.x;
  }
  float grain = clamp(relief * (1.6 * tufts + 0.8 * patch_at.y + 0.5 * patch_at.x), -0.8, 0.8);
  vec3 bare = soil * (sky_light.rgb * (0.85 + 0.3 * grain) + sun_light.rgb * (lit * max(to_sun.y * (0.8 + 0.3 * grain) + 0.25 * grain, 0.0)));
  light = mix(bare, light, smoothstep(0.0, 0.1, growth_here));
  light += mix(soil, tint_of(patch_at, 0.5), 0.85 * far * smoothstep(0.0, 0.1, growth_here)) * fire_light(place_m, vec3(0.0, 1.0, 0.0));
  color = vec4(dithered(seen(light, place_m), gl_FragCoord.xy), 1.0);
}
