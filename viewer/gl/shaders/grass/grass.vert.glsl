#include "sward.part.glsl"
#include "blade.part.glsl"
// A streamed blade. Slots of drawn blades come in blocks of 16, as their bends do.
uniform int first_corner;
uniform Numbers blades;          // three texels a blade: TiledBlade
uniform Numbers streamed_bends;  // of the slots: east, south, radians
uniform WholeNumbers blocks;     // of the slots: the number of each block
uniform float thinning;          // Thinning::factor()

void main() {
  int corners = 2 * rings + 1;
  int number = first_corner + gl_VertexID;
  int slot = number / corners;
  int blade = int(fetch(blocks, slot >> 4).r) * 16 + (slot & 15);
  vec4 root_length = fetch(blades, 3 * blade);
  vec4 traits = fetch(blades, 3 * blade + 2);  // width, bearing of the flat side, chance, rank

  // Farther away fewer blades stand, and wider ones; one that goes sinks into the ground.
  float distance_m = max(distance(eye_m.xyz, root_length.xyz), 0.01);
  float share = kept_share(thinning, distance_m);
  float is_up = share < 1.0 ? clamp((share - traits.w) / (0.12 * share), 0.0, 1.0) : 1.0;
  is_up *= 1.0 - smoothstep(0.5 * reach_m, reach_m, distance_m);
  if (is_up <= 0.0) {
    gl_Position = kNowhere;
    shade = vec3(0.0);
    return;
  }
  vec4 rest = fetch(blades, 3 * blade + 1);  // how its foot leans, and how far it is turned up to its tip
  vec2 turned = rest.zw + fetch(streamed_bends, slot).rg;
  // The viewer's own waves do not move streamed blades.
  vec2 around = bends_place.z > 0.0 ? bend_mean.xy : bend_at(root_length.xz);
  put_corner(number - slot * corners, root_length.xyz, root_length.w * is_up, rest.xy, turned, traits.x * pow(share, -0.7) * is_up,
             traits.y, traits.z, patches(root_length.xz, 0.0), around, 1.0);
}
