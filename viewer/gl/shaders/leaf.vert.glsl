// A leaf: a stalk and a blade along a strand's joints, with its light: sun on it, sun through it, the sky, less of each
// inside the crown. Its two faces turn with it, and the lower one is paler, so that the crown brightens where the wind
// turns leaves over.
uniform int first;
uniform vec3 crown_middle_m;
uniform vec3 crown_radius_m;

layout(location = 0) in vec4 root_half;  // metres; w: half the width
layout(location = 1) in vec4 tint;
layout(location = 2) in vec3 facing;     // normal of its upper side at rest
layout(location = 3) in uint strand;
layout(location = 4) in int root_at;
layout(location = 5) in vec3 rest;       // unit vector from foot to tip at rest

out vec3 shade;

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

void main() {
  int ring = gl_VertexID >> 1;
  float side = float(gl_VertexID & 1) * 2.0 - 1.0;
  vec3 root = root_at < 0 ? root_half.xyz : joint_at(root_at);
  vec3 place = ring > 0 ? joint(first, strand, ring - 1) : root;
  vec3 below = ring > 1 ? joint(first, strand, ring - 2) : root;
  vec3 along = normalize((ring > 0 ? place : joint(first, strand, 0)) - below);
  vec3 to_eye = eye_m.xyz - place;
  float distance_m = length(to_eye);
  to_eye /= distance_m;

  vec3 upper = turned(facing, rest, normalize(joint(first, strand, links - 1) - root));

  // A stalk for a fifth of it, then the blade: widest before its middle, pointed.
  float t = float(ring) / float(links);
  float blade = clamp((t - 0.2) / 0.8, 0.0, 1.0);
  float half_width = root_half.w * max(0.07, 2.3 * sqrt(blade) * (1.0 - blade) * (1.0 + 0.25 * blade)) * step(t, 0.999);
  half_width = max(half_width, 0.45 * eye_m.w * distance_m * step(t, 0.999) * step(0.2, t));
  vec3 across = normalize(cross(along, upper));
  vec3 normal = cross(across, along);
  place += across * (side * half_width) + normal * (0.22 * half_width);
  vec3 face = dot(normal, to_eye) < 0.0 ? lower_face(tint.rgb) : tint.rgb;
  normal *= dot(normal, to_eye) < 0.0 ? -1.0 : 1.0;
  normal = normalize(normal + across * (side * 0.30));
  gl_Position = to_clip * vec4(place, 1.0);

  vec3 in_crown = (place - crown_middle_m) / crown_radius_m;
  float depth = length(in_crown);
  float open = smoothstep(0.30, 1.05, depth);
  float to_light = smoothstep(-1.1, 0.9, dot(in_crown, normalize(to_sun.xyz / crown_radius_m)));
  float to_sun_part = dot(normal, to_sun.xyz);
  float against = max(-dot(to_eye, to_sun.xyz), 0.0);
  vec3 through = tint.rgb * vec3(1.25, 1.10, 0.75) * max(-to_sun_part, 0.14) * (0.50 + 1.35 * against * against);
  vec3 sum = face * soft_light(normal) * (0.55 + 0.45 * open);
  float in_sun = mix(0.30, 1.0, sunlight_near(place + 0.25 * to_sun.xyz));
  sum += kSunLight * in_sun * (face * max(to_sun_part, 0.0) * 0.75 + through) * (0.22 + 0.78 * open) * (0.42 + 0.58 * to_light);
  float shine = max(dot(normal, normalize(to_sun.xyz + to_eye)), 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  sum += kSunLight * 0.05 * shine * shine * to_light;
  shade = seen(sum, place);
}
