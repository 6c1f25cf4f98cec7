#include "grain.part.glsl"
#include "wood.part.glsl"
// Boards of weathered cedar, with gaps between them and joints that are not in a row.
uniform vec3 middle_m;
uniform vec2 along;
uniform vec2 half_m;
uniform vec3 through;  // the share of the sun's light that comes through the cloth that shades it

in vec3 place_m;
in vec3 normal;
in float unshaded;  // 0 where the cloth is known to be before the sun
in float thin;      // how much of what comes through is left, where the cloth is folded
out vec4 color;

const vec3 kCedar = vec3(0.185, 0.125, 0.080);
const float kBoard_m = 0.145;
const float kBoardLength_m = 2.1;

// The share of a pixel that is within so much of 0.
float gap(float beside_m, float half_m) {
  float pixel = max(fwidth(beside_m), 1e-5);
  return min(2.0 * half_m / pixel, 1.0) * (1.0 - smoothstep(half_m, half_m + pixel, abs(beside_m)));
}

void main() {
  vec3 from_eye = normalize(place_m - eye_m.xyz);
  vec3 way = place_m - middle_m;
  vec2 at_m = vec2(way.x * along.x + way.z * along.y, way.z * along.x - way.x * along.y);
  if (any(greaterThan(abs(at_m), half_m + 0.001))) discard;
  bool is_top = normal.y > 0.5;

  float board = floor(at_m.x / kBoard_m);
  float in_board_m = at_m.x - (board + 0.5) * kBoard_m;
  float own = lattice(ivec2(int(board), 77));
  float length_at_m = at_m.y + kBoardLength_m * own;
  float piece = floor(length_at_m / kBoardLength_m + 0.5);
  float from_joint_m = length_at_m - piece * kBoardLength_m;
  float piece_own = lattice(ivec2(int(board) * 7 + int(floor(length_at_m / kBoardLength_m)), 31));

  vec3 paint = kCedar * (0.80 + 0.40 * piece_own) * mix(vec3(1.0), vec3(0.90, 0.97, 1.08), lattice(ivec2(int(board), 5)));
  paint = wood(paint, vec2(at_m.y + 3.1 * own, at_m.x + 1.7 * own));
  float from_edge_m = 0.5 * kBoard_m - abs(in_board_m);
  float dark = is_top ? max(gap(from_edge_m, 0.003), gap(from_joint_m, 0.0015)) : 0.45 * smoothstep(0.0, 1.0, -way.y / max(middle_m.y + 0.02, 0.03));
  // The edges of boards are rounded.
  vec3 facing = normal;
  if (is_top) {
    float round_off = (1.0 - smoothstep(0.003, 0.014, from_edge_m)) * clamp(1.5 - 180.0 * fwidth(at_m.x), 0.0, 1.0);
    facing = normalize(normal + 0.35 * round_off * sign(in_board_m) * vec3(along.x, 0.0, along.y));
  }
  paint *= 1.0 - 0.92 * dark;

  float lit = unshaded * sunlight_at(place_m + 0.008 * to_sun.xyz, pixel_chance(gl_FragCoord.xy));
  vec3 sun = sun_light.rgb * below_clouds(place_m) * mix(thin * through, vec3(1.0), lit);
  vec3 light = paint * (0.95 * soft_light(facing) + 0.85 * sun * max(dot(facing, to_sun.xyz), 0.0));
  light += paint * fire_light(place_m, facing);

  // Worn smooth, it reflects the air at a flat angle (C. Schlick 1994, "An inexpensive BRDF model").
  float rim = 1.0 - max(dot(normal, -from_eye), 0.0);
  float rim_2 = rim * rim;
  vec3 mirrored = reflect(from_eye, normal);
  if (is_top) light += (0.015 + 0.16 * rim_2 * rim_2 * rim) * (1.0 - dark) * air_light(mirrored) * mix(0.6, 1.0, lit);
  color = vec4(seen(light, place_m), 1.0);
}
