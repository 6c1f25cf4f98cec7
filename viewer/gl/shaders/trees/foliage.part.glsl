// How leaves differ from tree to tree, and within a crown.
uniform int has_palette;    // 0: they have a color of their own in every season
uniform float turns_red;    // how far the species' leaves turn: 1 as far as the palette knows
uniform float silver;       // how pale the lower faces are: 0 hardly, 1 like a poplar's

// The lower face's color: brighter than the upper one's, and greyer, because of hairs and wax.
vec3 lower_face(vec3 upper_face) {
  float grey = dot(upper_face, vec3(0.21, 0.72, 0.07));
  vec3 pale = mix(upper_face, grey * vec3(0.98, 1.0, 0.92), 0.30 + 0.45 * silver) * (1.6 + 1.3 * silver);
  return min(pale, vec3(0.55));
}

// The palette's factor on a leaf. In autumn those turn first that have the most light. `tree`, `twig`: from 0 to 1.
vec3 palette_of(float tree, float twig, float open_share) {
  vec3 own = mix(vec3(0.90, 0.96, 0.92), vec3(1.10, 1.04, 1.08), tree);
  if (has_palette == 0) return own;
  float turned = clamp(1.2 * tree - 0.1 + 0.7 * (twig - 0.5) + 0.7 * (open_share - 0.4), 0.0, 1.0);
  return own * mix(leaves.rgb, turned_leaves.rgb, turned * turns_red);
}

// How much of a leaf is left, where `hanging` of them are; `chance`: which falls when. They shrink as they fall.
float hangs(float hanging, float chance) { return clamp((1.12 * hanging - chance) / 0.12, 0.0, 1.0); }

// Of leaves that the wind has turned by `blown` (SprayPlace), how many are turned over; `chance`: which before the others.
float turned_over(float blown, float chance) { return smoothstep(0.0, 0.25, smoothstep(0.04, 0.75, blown) - chance); }
