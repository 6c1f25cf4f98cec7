// A branch: a tapering tube along a strand's joints.
uniform int first;  // index of the level's first joint
uniform int rings;
uniform int sides;
uniform float bare;  // the part of its length, from the foot, on which nothing grows
// TreePlace (viewer/meshes/trees/tree_place.hpp).
uniform vec3 place_from_m;
uniform vec4 place_to_m;  // w: scale
uniform vec2 place_turn;  // cosine, sine

layout(location = 0) in vec4 root_base;  // metres; w: radius there
layout(location = 1) in vec4 tint_tip;   // w: radius at the tip, metres
layout(location = 2) in vec3 aside;
layout(location = 3) in uint strand;
layout(location = 4) in int root_at;     // of the parent's joint; below 0: it stands on the ground

layout(location = 5) in vec3 bow;        // how far it is drawn aside of its joints at most, metres

out vec3 place_m;
out vec3 normal;
out vec3 tint;
out vec2 bark_m;  // position around the branch and along it
out float above_foot_m;
// For the pictures of impostors (impostor_look.frag.glsl).
out vec3 own_color;
out vec3 own_normal;
out float own_open;

vec3 turned(vec3 v) { return vec3(place_turn.x * v.x - place_turn.y * v.z, v.y, place_turn.y * v.x + place_turn.x * v.z); }

// The middle of the branch after so many links: its joint there, aside by a part of its bow, which is 0 at the foot and
// from the first twig on.
vec3 middle_at(int link, vec3 root) {
  float along = min(float(link) / (float(links) * max(bare, 1e-3)), 1.0);
  return (link > 0 ? joint(first, strand, link - 1) : root) + 6.75 * along * (1.0 - along) * (1.0 - along) * bow;
}

void main() {
  int ring = gl_VertexID / (sides + 1);
  float turn = 6.2831853 * float(gl_VertexID % (sides + 1)) / float(sides);
  int link = ring * links / rings;
  int link_below = max(ring - 1, 0) * links / rings;
  int link_above = min(ring + 1, rings) * links / rings;
  vec3 root = root_at < 0 ? root_base.xyz : joint_at(root_at);
  vec3 middle = middle_at(link, root);
  vec3 along = normalize(middle_at(max(link_above, 1), root) - middle_at(link_below, root));
  vec3 across = normalize(cross(along, aside));
  normal = cos(turn) * across + sin(turn) * cross(along, across);

  // A trunk widens into its roots at the ground; a branch into a collar where it leaves its parent.
  float t = float(link) / float(links);
  float radius = mix(root_base.w, tint_tip.w, t);
  float from_root = distance(root, middle) / root_base.w;
  if (root_at < 0) {
    float roots = 1.0 + 0.26 * sin(5.0 * turn) + 0.18 * sin(3.0 * turn + 1.3);
    radius *= 1.0 + 1.1 * exp(-0.85 * from_root) * roots;
  } else {
    radius *= 1.0 + 0.8 * exp(-0.22 * from_root);
  }
  tint = tint_tip.rgb;
  bark_m = vec2(turn * root_base.w, distance(root, middle));
  above_foot_m = root_at < 0 ? bark_m.y : 1e3;
  middle = place_to_m.xyz + place_to_m.w * turned(middle - place_from_m);
  normal = turned(normal);
  radius = max(place_to_m.w * radius, 0.35 * eye_m.w * distance(eye_m.xyz, middle));
  place_m = middle + radius * normal;
  own_color = 0.7 * tint;
  own_normal = dot(normal, eye_m.xyz - place_m) < 0.0 ? -normal : normal;
  own_open = 0.25;
  gl_Position = to_clip * vec4(place_m, 1.0);
}
