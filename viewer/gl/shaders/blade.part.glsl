// A blade's ribbon: a point of its middle line becomes a vertex with its light. Behind sward.part.glsl.

const float kFarFrom_m = 6.0;  // where that begins
const float kFar_m = 20.0;     // from here on it is all
const vec4 kNowhere = vec4(2.0, 2.0, 2.0, 1.0);  // outside of the picture: a blade without length would leave dots
uniform bool is_far;           // every blade that is drawn is farther away than that

out vec3 shade;  // the screen's value; blades are so small that one for each vertex is exact enough

// Some blades bear seed heads, and some are flowers, in patches.
bool is_seed(float chance) { return chance > 0.93; }
bool is_flower(float chance, vec2 patch_at) { return chance < 0.10 * smoothstep(0.02, 0.22, patch_at.y - 0.6 * patch_at.x); }

void put_vertex(vec3 place, vec3 along, float t, float side, float width_m, float facing_rad, float chance, vec2 patch_at, vec2 bend, float lean, float tall) {
  vec3 to_eye = eye_m.xyz - place;
  float distance_m = length(to_eye);
  to_eye /= distance_m;

  // The flat side faces the blade's own bearing, turned half way to the eye, so that no blade is seen edge-on.
  vec3 across_eye = normalize(cross(along, to_eye));
  vec3 grown = vec3(cos(facing_rad), 0.0, sin(facing_rad));
  grown *= dot(grown, across_eye) < 0.0 ? -1.0 : 1.0;
  vec3 across = normalize(mix(across_eye, grown, 0.45));

  // Widest above the foot, pointed at the tip; a stem with a spindle of seeds, or with petals. Nowhere else thinner than
  // a pixel.
  float profile = (0.72 + 0.85 * t) * sqrt(1.0 - t) * (1.0 - 0.35 * t * t);
  vec3 tint = tint_of(patch_at, chance);
  tint *= 0.8 + 0.4 * fract(chance * 61.0);
  float head = 0.0;
  if (is_seed(chance)) {
    float from_head = (t - 0.87) * 9.0;
    head = exp(-from_head * from_head);
    profile = 0.30 * profile + 0.85 * head;
    tint = mix(tint, vec3(0.36, 0.27, 0.15), 0.35 + 0.65 * head);
  } else if (is_flower(chance, patch_at)) {
    head = smoothstep(0.80, 0.89, t) * (1.0 - smoothstep(0.96, 1.0, t));
    profile = 0.28 * profile + 1.5 * head;
    float hue = fract(chance * 977.0);
    vec3 petals = hue < 0.45 ? vec3(0.72, 0.70, 0.62) : hue < 0.75 ? vec3(0.70, 0.45, 0.05) : vec3(0.34, 0.14, 0.42);
    tint = mix(tint, petals, smoothstep(0.78, 0.88, t));
  }
  float half_width_m = max(0.5 * width_m * profile, 0.42 * eye_m.w * distance_m * min(1.0, 4.0 * (1.0 - t)));
  place += across * (side * half_width_m);
  gl_Position = to_clip * vec4(place, 1.0);

  float sunlight = mix(kSunInShadow, 1.0, sunlight_near(place));
  vec3 fire = tint * fire_light(place, vec3(0.0, 0.7, 0.0) + 0.5 * to_eye) * (0.2 + 0.8 * t);
  // Far away it takes on the light of the grass as a whole, as the ground behind it has it.
  vec3 canopy = canopy_light(bend, to_eye, patch_at, (t - 0.55) * 0.6 + 0.35 * (fract(chance * 61.0) - 0.5), tall, sunlight);
  if (is_far) {
    shade = seen(canopy + fire, place);
    return;
  }
  // A blade is folded along its middle: the normals of its two edges differ a little.
  vec3 normal = normalize(cross(across, along));
  normal *= dot(normal, to_eye) < 0.0 ? -1.0 : 1.0;
  normal = normalize(normal + across * (side * 0.55));
  vec3 light = blade_light(to_eye, along, normal, t, tint, lean, sunlight);
  shade = seen(mix(light, canopy, smoothstep(kFarFrom_m, kFar_m, distance_m)) + fire, place);
}
