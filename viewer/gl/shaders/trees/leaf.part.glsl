// A spray: leaves at alternate sides of a stalk that follows a strand, flowers on stalks of their own, or bare twigs.
// With their light: the sun's on them and through them, the sky's, less of each inside the crown. A leaf's two faces
// turn with it, and the lower one is paler, so that the crown brightens where the wind turns leaves over.
//
// Of light a green leaf reflects some 5 % of blue, 12 % of green and 6 % of red, and lets through as much of green and
// red but hardly any blue (S. Jacquemoud and F. Baret 1990, "PROSPECT: a model of leaf optical properties spectra").
uniform int kind;      // SprayShape::Kind: 0 leaves, 1 flowers, 2 twigs
uniform float hanging; // how many of the leaves are left; of twigs that leaves hide, how far they are seen, 0 to 1
uniform float leafy;   // how many leaves there are around, 0 to 1
uniform float tree_chance;  // TreePlace::chance()
uniform float thinnest_px;  // half as wide is a twig at least

// SprayPlace (viewer/meshes/trees/crown.hpp).
layout(location = 0) in vec4 root_length;  // metres
layout(location = 1) in vec4 tip_leaves;   // w: leaves drawn; the last one in part
layout(location = 2) in vec4 bow_blown;
layout(location = 3) in vec4 upper_size;
layout(location = 4) in vec4 tint_number;
layout(location = 5) in vec4 open;
layout(location = 6) in vec4 corner;       // where its leaf grows, its side, the place along and across it (SprayCorner)
layout(location = 7) in vec2 edge_leaf;

out vec3 shade;
// For the pictures of impostors (impostor_look.frag.glsl): without the palette's factor.
out vec3 own_color;
out vec3 own_normal;
out float own_open;

bool is_lit();                                   // false: only its place is needed
float sun_seen_in_map(float sun_seen, vec3 place);  // `sun_seen`: by the mean of the crown

const float kStalkRadius_m = 0.0011;
const float kTwigRadius_m = 0.0022;
const float kPedicel_m = 0.030;

// Three numbers from 0 to 1 that stay with a leaf (after M. Jarzynski and M. Olano 2020, "Hash functions for GPU
// rendering", pcg3d).
vec3 chances(uint a, uint b) {
  uvec3 v = uvec3(a, b, a ^ 0x9e3779b9u) * 1664525u + 1013904223u;
  v += v.yzx * v.zxy;
  v ^= v >> 16u;
  v += v.yzx * v.zxy;
  return vec3(v >> 8u) / 16777216.0;
}

void main() {
  vec3 root = root_length.xyz;
  vec3 tip = tip_leaves.xyz;
  vec3 bow = bow_blown.xyz;
  float blown = bow_blown.w;
  float t = corner.x;
  vec3 stem = mix(root, tip, t) + bow * (t * (1.0 - t));
  vec3 along = normalize(tip - root + bow * (1.0 - 2.0 * t));
  vec3 across = normalize(cross(along, upper_size.xyz));
  vec3 upper = cross(across, along);

  vec3 chance = chances(uint(tint_number.w), uint(edge_leaf.y));
  float part = clamp(tip_leaves.w - edge_leaf.y, 0.0, 1.0);
  float size = root_length.w * upper_size.w * part * (0.75 + 0.5 * chance.x);
  vec3 tint = tint_number.rgb * (0.82 + 0.36 * chance.z);
  if (kind == 0) {
    uint twig = uint(tint_number.w) >> 4u;
    if (hanging < 1.0) size *= hangs(hanging, chances(uint(tint_number.w) + 7919u, uint(edge_leaf.y)).y);
    tint *= palette_of(tree_chance, float((twig * 2654435769u) >> 8u) / 16777216.0, open.w);
  }
  vec4 open_now = mix(vec4(0.0, 0.0, 0.0, 1.0), open, leafy);
  vec3 place = stem;
  vec3 normal = upper;
  float thin = 1.0;  // how much light comes through
  float pixel_m = eye_m.w * distance(eye_m.xyz, stem);
  if (kind == 2) {
    float turn = corner.y * (0.55 + 0.45 * chance.x);
    vec3 to = normalize(cos(turn) * along + sin(turn) * across + (1.4 * chance.y - 0.7) * abs(corner.y) * upper);
    vec3 aside = cross(to, normalize(eye_m.xyz - stem));
    place = mix(root, stem, hanging) + to * (corner.z * root_length.w * part * hanging * (0.6 + 0.8 * chance.z));
    place += aside * (inversesqrt(max(dot(aside, aside), 1e-6)) * corner.w * min(hanging * 8.0, 1.0) * max(kTwigRadius_m * edge_leaf.x, thinnest_px * pixel_m));
    normal = normalize(eye_m.xyz - stem);
    thin = 0.0;
  } else if (corner.y > 1.5) {
    place += across * (corner.w * max(kStalkRadius_m, 0.3 * pixel_m));
    tint = kind == 1 ? vec3(0.10, 0.085, 0.035) : tint * vec3(0.9, 0.7, 0.6);
    thin = 0.3;
  } else if (kind == 1) {
    // To all sides around the strand.
    vec3 to = normalize(along * (1.4 * chance.x - 0.5) + across * (2.0 * chance.y - 1.0) + upper * (2.0 * chance.z - 1.0) + 0.001);
    vec3 leaf_across = normalize(cross(to, along + 0.01));
    vec3 leaf_up = cross(leaf_across, to);
    place += to * (kPedicel_m * (0.7 + 0.6 * chance.y)) + size * (corner.z * leaf_up + corner.w * leaf_across);
    place += to * (0.22 * size * (edge_leaf.x * edge_leaf.x) * length(corner.zw));
    normal = normalize(to - 0.8 * (corner.z * leaf_up + corner.w * leaf_across));
    tint *= mix(vec3(0.86, 0.42, 0.50), vec3(1.0), smoothstep(0.0, 0.55, edge_leaf.x));
  } else {
    // Where the wind turns the strand, each leaf turns a little differently.
    float turn = corner.y == 0.0 ? 0.5 * (chance.x - 0.5) : corner.y * (0.65 + 0.5 * chance.x);
    // In a storm they lie along the stalk (S. Vogel 1989, "Drag and reconfiguration of broad leaves in high winds").
    turn *= 1.0 - 0.65 * smoothstep(0.05, 0.6, blown);
    vec3 to = normalize(cos(turn) * along + sin(turn) * across + (0.9 * chance.y - 0.65 + 0.7 * (chance.z - 0.5) * blown) * upper);
    vec3 leaf_across = normalize(cross(to, upper));
    vec3 leaf_up = cross(leaf_across, to);
    // The harder it blows, the more of them are turned over, so that their lower faces stream in the gust.
    float over = turned_over(blown, chance.y);
    float roll = 1.7 * (chance.z - 0.5) + 2.0 * (chance.y - 0.5) * blown + (chance.x < 0.5 ? -2.5 : 2.5) * over;
    normal = cos(roll) * leaf_up + sin(roll) * leaf_across;
    leaf_across = cross(to, normal);
    // Folded along the midrib, and bent down toward the tip.
    place += size * (corner.z * to + corner.w * leaf_across);
    place += normal * (size * (0.30 * abs(corner.w) - 0.55 * corner.z * corner.z));
    normal = normalize(normal - leaf_across * (0.30 * sign(corner.w) * edge_leaf.x) + to * (1.1 * corner.z - 0.2));
    tint *= 1.12 - 0.12 * edge_leaf.x;
  }
  gl_Position = to_clip * vec4(place, 1.0);
  shade = vec3(0.0);
  if (!is_lit()) return;

  vec3 to_eye = normalize(eye_m.xyz - place);
  bool is_below = dot(normal, to_eye) < 0.0;
  vec3 face = is_below && kind == 0 ? lower_face(tint) : tint;
  normal *= is_below ? -1.0 : 1.0;

  own_color = face;
  own_normal = normal;
  own_open = 0.5 + 0.5 * clamp(open_now.w + 0.45 * dot(open_now.xyz, normal), 0.0, 1.0);

  vec3 sun = sun_light.rgb * below_clouds(place);
  // What the crown lets through to here.
  float sun_seen = sun_seen_in_map(clamp(open_now.w + dot(open_now.xyz, to_sun.xyz), 0.02, 1.0), place);
  float sky_seen = clamp(open_now.w + 0.45 * dot(open_now.xyz, normal + vec3(0.0, 0.3, 0.0)), 0.32, 1.0);
  vec3 sum = face * soft_light(normal) * sky_seen;
  if (fire_count.x > 0.0) sum += face * (fire_light(place, normal) + 0.4 * fire_light(place, -normal));

  float facing = dot(normal, to_sun.xyz);
  float against = max(-dot(to_eye, to_sun.xyz), 0.0);
  vec3 through_leaf = kind == 0 ? tint * vec3(0.95, 1.25, 0.35) : face * vec3(1.0, 0.94, 0.95);
  // Through a leaf light goes on a little more straight than to all sides.
  vec3 sunlit = facing > 0.0 ? face * facing : through_leaf * (thin * -facing * (0.95 + 1.1 * against * against * against));
  sum += sun * sun_seen * sunlit;
  // And light that other leaves, which the sun reaches, have reflected and let through: it comes from all around, the
  // more the nearer the sun, and fades with the depth in the crown.
  float from_others = (0.10 + 0.30 * sun_seen) * (0.35 + 0.65 * min(2.5 * open_now.w, 1.0)) * (1.0 - 0.5 * open_now.w);
  sum += sun * (0.35 * tint + 0.65 * through_leaf) * (0.42 * from_others * thin);

  float shine = max(dot(normal, normalize(to_sun.xyz + to_eye)), 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  if (kind == 0) sum += sun * 0.05 * shine * shine * sun_seen;
  shade = seen(sum, place);
}
