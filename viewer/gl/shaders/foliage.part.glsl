// How leaves differ from tree to tree, and within a crown.
uniform int has_palette;    // 0: they have a color of their own in every season
uniform float turns_red;    // how far the species' leaves turn: 1 as far as the palette knows

// The palette's factor on a leaf. In autumn those turn first that have the most light. `tree`, `twig`: from 0 to 1.
vec3 palette_of(float tree, float twig, float open_share) {
  vec3 own = mix(vec3(0.90, 0.96, 0.92), vec3(1.10, 1.04, 1.08), tree);
  if (has_palette == 0) return own;
  float turned = clamp(1.2 * tree - 0.1 + 0.7 * (twig - 0.5) + 0.7 * (open_share - 0.4), 0.0, 1.0);
  return own * mix(leaves.rgb, turned_leaves.rgb, turned * turns_red);
}

// How much of a leaf is left, where `hanging` of them are; `chance`: which falls when. They shrink as they fall.
float hangs(float hanging, float chance) { return clamp((1.12 * hanging - chance) / 0.12, 0.0, 1.0); }
