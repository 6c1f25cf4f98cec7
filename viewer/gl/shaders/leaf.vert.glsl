// A spray: leaves at alternate sides of a stalk that follows a strand's joints, or flowers on stalks of their own. With
// their light: sun on them, sun through them, the sky, less of each inside the crown. A leaf's two faces turn with it,
// and the lower one is paler, so that the crown brightens where the wind turns leaves over.
uniform int first;
uniform vec3 crown_middle_m;
uniform vec3 crown_radius_m;
uniform float leaves_drawn;  // of each spray; the last one is drawn in part
uniform float leaf_size;     // larger where few are drawn
uniform bool has_flowers;

layout(location = 0) in vec4 root_half;  // metres; w: half the strand's width
layout(location = 1) in vec4 tint_length;  // w: the strand's length, metres
layout(location = 2) in vec3 facing;     // normal of its upper side at rest
layout(location = 3) in uint strand;
layout(location = 4) in int root_at;
layout(location = 5) in vec3 rest;       // unit vector from foot to tip at rest
layout(location = 6) in vec4 corner;     // where its leaf grows, its side, the place along and across it (SprayCorner)
layout(location = 7) in vec2 edge_leaf;

out vec3 shade;

const float kStalkRadius_m = 0.0011;
const float kPedicel_m = 0.030;

// The vector, turned by the shortest rotation from `from` to `to` (unit vectors).
vec3 turned(vec3 vector, vec3 from, vec3 to) {
  vec3 axis = cross(from, to);
  float cosine = dot(from, to);
  return cosine * vector + cross(axis, vector) + axis * (dot(axis, vector) / max(1.0 + cosine, 0.05));
}

// The lower face's color: up to twice as bright as the upper one's, and greyer, because of hairs and wax.
vec3 lower_face(vec3 upper_face) {
  vec3 greyer = mix(vec3(dot(upper_face, vec3(0.21, 0.72, 0.07))), upper_face, 0.55);
  return greyer * (2.0 - greyer);
}

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
  // The parabola through the strand's root, one of its joints near the middle, and its tip.
  vec3 root = root_at < 0 ? root_half.xyz : joint_at(root_at);
  vec3 tip = joint(first, strand, links - 1);
  float u = links > 1 ? float(links / 2) / float(links) : 0.5;
  vec3 middle = links > 1 ? joint(first, strand, links / 2 - 1) : 0.5 * (root + tip);
  float t = corner.x;
  vec3 bow = (middle - mix(root, tip, u)) / (u * (1.0 - u));
  vec3 stem = mix(root, tip, t) + bow * (t * (1.0 - t));
  vec3 along = normalize(tip - root + bow * (1.0 - 2.0 * t));
  vec3 strand_to = normalize(tip - root);
  vec3 upper = turned(facing, rest, strand_to);
  vec3 across = normalize(cross(along, upper));
  upper = cross(across, along);

  vec3 chance = chances(strand, uint(edge_leaf.y));
  float size = tint_length.w * leaf_size * clamp(leaves_drawn - edge_leaf.y, 0.0, 1.0) * (0.75 + 0.5 * chance.x);
  vec3 tint = tint_length.rgb * (0.78 + 0.44 * chance.z);
  vec3 place = stem;
  vec3 normal = upper;
  vec3 leaf_across = across;
  if (corner.y > 1.5) {
    place += across * (corner.w * max(kStalkRadius_m, 0.3 * eye_m.w * distance(eye_m.xyz, stem)));
    tint = has_flowers ? vec3(0.10, 0.085, 0.035) : tint * vec3(0.9, 0.7, 0.6);
  } else if (has_flowers) {
    // To all sides around the strand.
    vec3 to = normalize(along * (1.4 * chance.x - 0.5) + across * (2.0 * chance.y - 1.0) + upper * (2.0 * chance.z - 1.0) + 0.001);
    normal = to;
    leaf_across = normalize(cross(to, along + 0.01));
    vec3 leaf_up = cross(leaf_across, to);
    place += to * (kPedicel_m * (0.7 + 0.6 * chance.y)) + size * (corner.z * leaf_up + corner.w * leaf_across);
    place += to * (0.22 * size * (edge_leaf.x * edge_leaf.x) * length(corner.zw));
    normal = normalize(normal - 0.8 * (corner.z * leaf_up + corner.w * leaf_across));
    tint *= mix(vec3(0.80, 0.36, 0.44), vec3(1.0), smoothstep(0.0, 0.7, edge_leaf.x));
  } else {
    // Where the wind turns the strand, each leaf turns a little differently.
    vec3 blown = strand_to - rest;
    float turn = corner.y == 0.0 ? 0.5 * (chance.x - 0.5) : corner.y * (0.65 + 0.5 * chance.x);
    vec3 to = normalize(cos(turn) * along + sin(turn) * across + (0.9 * chance.y - 0.65 + 0.7 * (chance.z - 0.5) * dot(blown, blown)) * upper);
    leaf_across = normalize(cross(to, upper));
    vec3 leaf_up = cross(leaf_across, to);
    float roll = 1.7 * (chance.z - 0.5) + 1.2 * (chance.y - 0.5) * dot(blown, across);
    normal = cos(roll) * leaf_up + sin(roll) * leaf_across;
    leaf_across = cross(to, normal);
    // Folded along the midrib, and bent down toward the tip.
    place += size * (corner.z * to + corner.w * leaf_across);
    place += normal * (size * (0.30 * abs(corner.w) - 0.55 * corner.z * corner.z));
    normal = normalize(normal - leaf_across * (0.30 * sign(corner.w) * edge_leaf.x) + to * (1.1 * corner.z - 0.2));
    tint *= 1.12 - 0.12 * edge_leaf.x;
  }

  vec3 to_eye = normalize(eye_m.xyz - place);
  vec3 face = dot(normal, to_eye) < 0.0 && !has_flowers ? lower_face(tint) : tint;
  normal *= dot(normal, to_eye) < 0.0 ? -1.0 : 1.0;
  gl_Position = to_clip * vec4(place, 1.0);

  vec3 in_crown = (place - crown_middle_m) / crown_radius_m;
  float depth = length(in_crown);
  float open = smoothstep(0.30, 1.05, depth);
  float to_light = smoothstep(-1.1, 0.9, dot(in_crown, normalize(to_sun.xyz / crown_radius_m)));
  float to_sun_part = dot(normal, to_sun.xyz);
  float against = max(-dot(to_eye, to_sun.xyz), 0.0);
  vec3 through = tint * vec3(1.25, 1.10, 0.75) * max(-to_sun_part, 0.14) * (0.50 + 1.35 * against * against);
  vec3 sum = face * soft_light(normal) * (0.55 + 0.45 * open);
  sum += face * (fire_light(place, normal) + 0.4 * fire_light(place, -normal));
  float in_sun = mix(0.30, 1.0, sunlight_near(place + 0.25 * to_sun.xyz));
  sum += sun_light.rgb * in_sun * (face * max(to_sun_part, 0.0) * 0.75 + through) * (0.22 + 0.78 * open) * (0.42 + 0.58 * to_light);
  float shine = max(dot(normal, normalize(to_sun.xyz + to_eye)), 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  sum += sun_light.rgb * 0.05 * shine * shine * to_light;
  shade = seen(sum, place);
}
