#include "foliage.part.glsl"
// The sheet of a far tree's impostor (viewer/meshes/trees/tree_impostor.hpp): it faces the eye, or the sun, and shows the
// picture of the side from which that sees the tree.
uniform vec3 to_middle_m;  // from the tree's foot to the middle of its pictures
uniform vec2 half_m;       // of their width and height
uniform int is_by_sun;
uniform float blown;  // the mean of its sprays (SprayPlace)

layout(location = 0) in vec4 foot_scale;
layout(location = 1) in vec4 turn_sway;
layout(location = 2) in vec3 share_hanging_chance;

out vec2 at;  // in the picture, -1 to 1
out vec3 place_m;
flat out vec3 toward;     // the eye
flat out vec3 turn_side;  // cosine and sine; and the side, not a whole number
flat out vec2 row_share;
flat out vec2 hanging_chance;
flat out float lower_share;  // how much more than at rest one sees of the lower faces of leaves

const float kSides = 8.0;
const float kRows = 3.0;
const float kLowest_rad = 0.07;
const float kStep_rad = 0.63;

void main() {
  at = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  float scale = foot_scale.w;
  vec2 turn = turn_sway.xy;
  vec3 aside = vec3(turn.x * to_middle_m.x - turn.y * to_middle_m.z, to_middle_m.y, turn.y * to_middle_m.x + turn.x * to_middle_m.z);
  vec3 middle = foot_scale.xyz + scale * aside;
  vec3 to_eye = is_by_sun == 1 ? to_sun.xyz : normalize(eye_m.xyz - middle);
  // As the tree sees it, before it is turned.
  vec2 from = vec2(turn.x * to_eye.x + turn.y * to_eye.z, turn.x * to_eye.z - turn.y * to_eye.x);
  float side = atan(from.x, from.y) / 6.2831853 * kSides;
  float row = clamp((asin(clamp(to_eye.y, -1.0, 1.0)) - kLowest_rad) / kStep_rad, 0.0, kRows - 1.0);
  float height_rad = kLowest_rad + kStep_rad * row;
  vec2 level = normalize(to_eye.xz + vec2(0.0, 1e-5));
  toward = vec3(cos(height_rad) * level.x, sin(height_rad), cos(height_rad) * level.y);
  vec3 right = vec3(level.y, 0.0, -level.x);
  place_m = middle + scale * (at.x * half_m.x * right + at.y * half_m.y * cross(toward, right));
  // Blown as a whole: the higher, the farther.
  float lever = max(place_m.y - foot_scale.y, 0.0) / max(scale * to_middle_m.y, 0.1);
  place_m.xz += scale * turn_sway.zw * lever;
  gl_Position = to_clip * vec4(place_m, 1.0);
  // While it fades in, it is before the leaves over which it does.
  float drawn_share = share_hanging_chance.x;
  if (drawn_share < 1.0 && is_by_sun == 0) {
    vec4 before = to_clip * vec4(place_m + scale * half_m.x * to_eye, 1.0);
    gl_Position.z = before.z / before.w * gl_Position.w;
  }
  turn_side = vec3(turn, side < 0.0 ? side + kSides : side);
  row_share = vec2(row, drawn_share);
  hanging_chance = share_hanging_chance.yz;
  // In a storm leaves are turned over, of some trees before others.
  lower_share = 0.14 * turned_over(blown * (0.75 + 0.5 * hanging_chance.y), 0.15);
}
