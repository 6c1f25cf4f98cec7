#include "sward.part.glsl"
#include "blade.part.glsl"
// A blade of the sward around the streamed ones. Tiles repeat the same blades, each tile turned in its own way; how they
// bend, how tall they are and what colour they have depends on where they stand.
uniform int first_corner;
uniform Numbers blades;   // two texels a blade of the tile: SwardBlade
uniform Numbers tiles;    // SwardTile
uniform int blades_per_tile;
uniform float thinning;   // Thinning::factor()
uniform float tile_m;
uniform float width_m;    // of a blade where none is left out
uniform float tall;       // 1: tall grass; 0: a lawn

void main() {
  int corners = 2 * rings + 1;
  int number = first_corner + gl_VertexID;
  int place = number / corners;
  int corner = number - place * corners;
  int slot = place / blades_per_tile;
  int blade = place - slot * blades_per_tile;
  vec4 tile = fetch(tiles, slot);
  vec4 form = fetch(blades, 2 * blade);        // x, z, facing, height
  vec4 traits = fetch(blades, 2 * blade + 1);  // heading, chance, droop, sway

  int turn = int(tile.z);
  vec2 on_tile = (turn & 1) == 1 ? form.yx : form.xy;
  on_tile.x = (turn & 2) == 2 ? 1.0 - on_tile.x : on_tile.x;
  on_tile.y = (turn & 4) == 4 ? 1.0 - on_tile.y : on_tile.y;
  vec2 root_m = tile.xy + on_tile * tile_m;

  vec2 patch_at = patches(root_m, 0.0);
  vec3 grown = growth_at(root_m);
  float chance = fract(traits.y + 0.37 * tile.z);
  float distance_m = max(distance(eye_m.xyz, vec3(root_m.x, 0.0, root_m.y)), 0.01);
  float share = kept_share(thinning, distance_m);
  float rank = (float(blade) + 0.5) / float(blades_per_tile);
  float is_up = share < 1.0 ? clamp((share - rank) / (0.12 * share), 0.0, 1.0) : 1.0;
  is_up *= 1.0 - smoothstep(0.5 * reach_m, reach_m, distance_m);
  is_up *= smoothstep(0.25, 0.9, distance_m);        // none in the eye
  is_up *= max(tall * grown.g, grown.b) > fract(chance * 31.0) ? 0.0 : 1.0;  // streamed ones stand here, or water
  float length_m = grown_m(grown.r, tall, fract(chance * 13.0)) * form.w * (1.0 + 0.55 * patch_at.y) * is_up;
  length_m *= is_seed(chance) || is_flower(chance, patch_at) ? 1.12 : 1.0;
  if (length_m < 1e-4) {
    gl_Position = kNowhere;
    shade = vec3(0.0);
    return;
  }

  // An arc: its own tilt and droop, and the wind's bend in proportion to the height.
  vec2 heading = vec2(sin(traits.x), -cos(traits.x));
  vec2 tilt = heading * mix(0.14, stand.w, tall) * traits.z;
  vec2 bend = bend_at(root_m);
  vec2 turned = heading * mix(0.6, stand.y, tall) * traits.z + bend * (traits.w * (0.35 + 0.65 * tall));
  put_corner(corner, vec3(root_m.x, 0.0, root_m.y), length_m, tilt, turned, width_m * pow(share, -0.7) * min(is_up * 2.0, 1.0),
             traits.x + form.z, chance, patch_at, bend, tall);
}
