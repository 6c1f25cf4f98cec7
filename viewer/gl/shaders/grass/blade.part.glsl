// A blade: a ribbon along an arc, of which a vertex is put with its light. Behind sward.part.glsl.

const float kFarFrom_m = 6.0;  // where that begins
const float kFar_m = 20.0;     // from here on it is all
const vec4 kNowhere = vec4(2.0, 2.0, 2.0, 1.0);  // outside of the picture: a blade without length would leave dots
uniform float reach_m;         // there are no blades beyond
uniform int rings;             // of vertices above the root, two each, but one at the tip

out vec3 shade;  // the screen's value; blades are so small that one for each vertex is exact enough

// Some blades bear seed heads, and some are flowers, in patches.
bool is_seed(float chance) { return chance > 0.93; }
bool is_flower(float chance, vec2 patch_at) { return chance < 0.10 * grass_fresh.w * smoothstep(0.02, 0.22, patch_at.y - 0.6 * patch_at.x); }

// A point of an arc of length 1, at part t of it, that leaves its foot leaning by `foot` and turns by `turned` up to its tip
// (tests/viewer/meshes/sward_test.cpp has the same).
vec3 arc_point(vec2 foot, vec2 turned, float t) {
  float half_2 = 0.25 * t * t * dot(turned, turned);
  return t * (1.0 - half_2 * (1.0 / 6.0 - half_2 / 120.0)) * leaning(foot + turned * (0.5 * t));
}

// Where a ring is on its blade, 0 foot to 1 tip. On a stem with a head, which begins at part `head_from`, most rings are in
// the head; of a small one the head alone is drawn.
float ring_at(int ring, float head_from) {
  float s = 1.0 - float(ring) / float(rings);
  if (head_from >= 1.0) return 1.0 - s * sqrt(s);  // closer to each other toward the tip
  int stem = rings > 3 ? rings / 3 : 0;
  return ring < stem ? head_from * float(ring) / float(stem) : mix(head_from, 1.0, float(ring - stem) / float(rings - stem));
}

// The nearest texel of a tile that is 256 of them wide: a blade is so narrow that it needs no value between two.
vec4 texel_at(sampler2D tile, vec2 at) { return texelFetch(tile, ivec2(floor(at * 256.0)) & 255, 0); }

// Corner v of a blade whose foot is here. `bend`: what the wind does to the grass around it.
void put_corner(int v, vec3 foot_m, float length_m, vec2 foot, vec2 turned, float width_m, float facing_rad, float chance, vec2 patch_at, vec2 bend, float tall) {
  bool has_seeds = is_seed(chance) && rings > 1;
  bool has_petals = is_flower(chance, patch_at) && rings > 1;
  float head_from = has_petals ? 1.0 - min(0.045 / length_m, 0.3) : has_seeds ? 0.72 : 1.0;
  if (head_from < 1.0) turned *= 0.8;  // stems are stiffer
  float side = v == 2 * rings ? 0.0 : float(v & 1) * 2.0 - 1.0;
  float t = ring_at(v >> 1, head_from);
  vec3 place = foot_m + length_m * arc_point(foot, turned, t);
  vec3 along = leaning(foot + turned * max(t, 0.15));
  vec3 to_eye = eye_m.xyz - place;
  float distance_m = length(to_eye);
  to_eye /= distance_m;
  float gust = kGust * seen_from(to_eye) * gust_of(bend);
  float lean = mix(0.55 + kLawnGust * gust, length(leaning(foot + turned * 0.5).xz) + gust, tall);

  // The flat side faces the blade's own bearing, turned half way to the eye, so that no blade is seen edge-on.
  vec3 across_eye = normalize(cross(along, to_eye));
  vec3 grown = vec3(cos(facing_rad), 0.0, sin(facing_rad));
  grown *= dot(grown, across_eye) < 0.0 ? -1.0 : 1.0;
  vec3 across = normalize(mix(across_eye, grown, 0.45));

  // Widest above the foot, pointed at the tip; a stem with a panicle of seeds, or with petals, whose outlines go in and out
  // from ring to ring. Nowhere else thinner than a pixel.
  float profile = (0.72 + 0.85 * t) * sqrt(1.0 - t) * (1.0 - 0.35 * t * t);
  // Of a lawn neighbours are alike: its color changes from patch to patch.
  float is_short = 1.0 - smoothstep(0.12, 0.30, length_m);
  float own = 1.0 - 0.8 * is_short;
  vec3 tint = tint_of(patch_at, mix(0.5, chance, own));
  tint *= 1.0 + 0.4 * own * (fract(chance * 61.0) - 0.5);
  float head_m = 0.0;  // half as wide
  float in_head = clamp((t - head_from) / max(1.0 - head_from, 0.01), 0.0, 1.0);
  bool is_out = (v >> 1 & 1) == (rings & 1);
  if (has_seeds) {
    float head = smoothstep(0.0, 0.2, in_head);
    profile *= 0.30;
    head_m = 0.010 * length_m * head * (1.0 - 0.7 * in_head) * (is_out ? 1.0 : 0.35);
    tint = mix(tint, 1.1 * grass_straw.rgb, 0.35 + 0.65 * head);
  } else if (has_petals) {
    float head = 1.0 - (2.0 * in_head - 1.0) * (2.0 * in_head - 1.0);
    profile *= 0.28;
    head_m = 0.5 * (1.0 - head_from) * length_m * sqrt(head) * (is_out ? 0.75 : 1.0);
    float hue = fract(chance * 977.0);
    vec3 petal = hue < 0.45 ? petals[0].rgb : hue < 0.75 ? petals[1].rgb : petals[2].rgb;
    tint = mix(tint, petal, smoothstep(0.0, 0.1, in_head));
    tint = mix(tint, vec3(0.62, 0.42, 0.05), rings > 5 ? smoothstep(0.7, 1.0, head) : 0.0);  // the heart
  }
  float half_width_m = max(max(0.5 * width_m * profile, head_m), 0.42 * eye_m.w * distance_m * min(1.0, 4.0 * (1.0 - t)));
  place += across * (side * half_width_m);
  gl_Position = to_clip * vec4(place, 1.0);

  float sunlight = mix(kSunInShadow, 1.0, sunlight_near(place)) * under_cloud(texel_at(noise_tile, in_clouds(foot_m.xz)).r);
  // Of a lawn one sees no single blades from so far.
  float far = max(smoothstep(kFarFrom_m, kFar_m, distance_m), is_short * lawn_far(distance_m));
  vec3 light = vec3(0.0);
  if (far < 1.0) {
    // A blade is folded along its middle: the normals of its two edges differ a little.
    vec3 normal = normalize(cross(across, along));
    normal *= dot(normal, to_eye) < 0.0 ? -1.0 : 1.0;
    normal = normalize(normal + across * (side * 0.55));
    light = blade_light(to_eye, along, normal, t, tint, lean, 1.0, sunlight);
  }
  // Far away it takes on the light of the grass as a whole, as the ground behind it has it.
  if (far > 0.0) {
    // Toward the last ones it is the ground's, so that no edge is seen where blades end.
    float tufts = ((t - 0.55) * mix(0.6, 0.4, is_short) + 0.35 * own * (fract(chance * 61.0) - 0.5)) * (1.0 - smoothstep(0.25 * reach_m, 0.8 * reach_m, distance_m));
    tufts += clump_of(texel_at(turf_tile, in_clumps(foot_m.xz)).b);
    vec3 canopy = canopy_light(bend, to_eye, patch_at, tufts, tall * (1.0 - is_short), sunlight);
    light = mix(light, canopy, far);
  }
  light += tint * fire_light(place, vec3(0.0, 0.7, 0.0) + 0.5 * to_eye) * (0.2 + 0.8 * t);
  shade = seen(light, place);
}
