#include "sward.part.glsl"
#include "blade.part.glsl"
// A streamed blade: a ribbon along a strand's joints, two vertices a joint and one at the tip. Vertex v of a blade is corner
// v % (2 rings + 1); slots of drawn blades come in blocks of 16, as their joints do.
uniform samplerBuffer blades;   // two texels a blade: root, width; bearing of the flat side, chance, rank, length: metres, radians
uniform usamplerBuffer blocks;  // of the slots: the number of each block
uniform int rings;              // of vertices above the root: at most links; fewer where the blade is far away
uniform float thinning;         // Thinning::factor()

void main() {
  int corners = 2 * rings + 1;
  int slot = gl_VertexID / corners;
  int corner = gl_VertexID - slot * corners;
  int blade = int(texelFetch(blocks, slot >> 4).r) * 16 + (slot & 15);
  vec4 root_width = texelFetch(blades, 2 * blade);
  vec4 traits = texelFetch(blades, 2 * blade + 1);

  // This ring's joint, and the one below (for the root, the one above).
  int ring = corner >> 1;
  float side = corner == 2 * rings ? 0.0 : float(corner & 1) * 2.0 - 1.0;
  uint at = uint(slot);
  vec3 place = ring > 0 ? joint(0, at, ring * links / rings - 1) : root_width.xyz;
  vec3 along = ring > 1 ? place - joint(0, at, (ring - 1) * links / rings - 1)
                        : (ring > 0 ? place : joint(0, at, links / rings - 1)) - root_width.xyz;
  vec3 chord = joint(0, at, links - 1) - root_width.xyz;

  // Farther away fewer blades stand, and wider ones; one that goes sinks into the ground.
  float share = kept_share(thinning, max(distance(eye_m.xyz, root_width.xyz), 0.01));
  float is_up = clamp((share - traits.z) / (0.12 * share), 0.0, 1.0);
  is_up = share < 1.0 ? is_up : 1.0;
  is_up *= 1.0 - smoothstep(0.5 * kTallReach_m, kTallReach_m, distance(eye_m.xyz, root_width.xyz));
  if (is_up <= 0.0) {
    gl_Position = kNowhere;
    shade = vec3(0.0);
    return;
  }
  place.y = root_width.y + (place.y - root_width.y) * is_up;
  put_vertex(place, normalize(along), float(ring) / float(rings), side, root_width.w * pow(share, -0.7) * is_up, traits.x, traits.y,
             patches(root_width.xz), bend_at(root_width.xz, 1.0), length(chord.xz) / length(chord), 1.0);
}
