// What grass is, wherever it grows: shared by the blades that are streamed, by those around them and by the ground that
// is seen between and behind them, so that none of them ends at a line.

layout(std140) uniform Ground {
  vec4 bends_place;   // x, z of the corner of the grid of bends; z: 1 if it is of the viewer's own waves, 0 if it is streamed
  vec4 bends_axes;    // a matrix: from metres behind it to parts of the grid's sides
  vec4 bend_mean;     // east, south, radians; w: share of tall grass
  vec4 growth_place;  // x, z of the low corner of the map of growth; 1 / its sides
  vec4 stand;         // tall grass: mean length, metres; curl, radians; number of the door through which it fades; tilt, radians
};
uniform sampler2D noise_tile;
uniform sampler2D turf_tile;  // gl::make_turf_texture()
uniform sampler2D bends;   // east, south, radians
uniform sampler2D growth;  // r: 0 bare, 1 nothing keeps grass from growing; g: streamed blades stand here; b: water

const float kLawnLength_m = 0.085;

// The bend of grass at a place. Beyond the grid its pattern is repeated, calmer at the edges of a streamed one, which does not fit
// itself.
vec2 bend_at(vec2 at_m) {
  vec2 uv = mat2(bends_axes.xy, bends_axes.zw) * (at_m - bends_place.xy);
  if (bends_place.z > 0.0) return textureLod(bends, uv, 0.0).rg;
  vec2 from_edge = 0.5 - abs(fract(uv) - 0.5);
  float sure = smoothstep(0.0, 0.09, min(from_edge.x, from_edge.y));
  return bend_mean.xy + (textureLod(bends, uv, 0.0).rg - bend_mean.xy) * sure;
}

vec3 growth_at(vec2 at_m) { return textureLod(growth, (at_m - growth_place.xy) * growth_place.zw, 0.0).rgb; }

// The share of blades that are tall.
float tall_share(float growth) { return clamp((growth - 0.25) / 0.70, 0.0, 1.0); }

// The length of a blade at a place: of a lawn where something is in the way, tall elsewhere. Between the two each blade is one or
// the other, by `chance`.
float grown_m(float growth, float tall, float chance) {
  float lawn_m = kLawnLength_m * smoothstep(0.02, 0.12, growth);
  float is_tall = clamp((1.03 * tall_share(growth) - chance) / 0.03, 0.0, 1.0);
  return mix(lawn_m, stand.x, tall * is_tall);
}

// Patches of moisture and soil, from -0.5 to 0.5: broad ones (x), and clumps (y).
vec2 patches(vec2 at_m, float blur) {
  return textureLod(turf_tile, mat2(0.8, 0.6, -0.6, 0.8) * at_m * 0.0061 + 0.17, blur).rg - 0.5;
}

// Clumps of 0.3 to 1.5 m that stand above what is around them, about from -0.5 to 0.5. `blur`: binary logarithm of a pixel's
// size, metres.
const float kClumps_per_m = 0.045;
vec2 in_clumps(vec2 at_m) { return mat2(0.6, -0.8, 0.8, 0.6) * at_m * kClumps_per_m + 0.53; }
float clump_of(float relief) { return 4.0 * (relief - 0.5); }
float clumps_at(vec2 at_m, float blur) {
  return clump_of(textureLod(turf_tile, in_clumps(at_m), blur + log2(256.0 * kClumps_per_m)).b);
}

// The colour of a blade's upper part: from a young blue-green over fresh green to straw. `chance` from 0 to 1.
vec3 tint_of(vec2 patch_at, float chance) {
  // Kinds of grass grow through each other: at a patch's edge blade by blade, so that it has no outline.
  float dryness = clamp(0.44 + grass_lush.w + 0.42 * patch_at.x + 0.50 * patch_at.y + 0.62 * (chance - 0.5), 0.0, 1.0);
  return dryness < 0.6 ? mix(grass_lush.rgb, grass_fresh.rgb, dryness / 0.6) : mix(grass_fresh.rgb, grass_straw.rgb, (dryness - 0.6) / 0.4);
}

// The share of the sun's light that clouds let through to a pixel of the ground.
float under_clouds(vec2 at_m, float pixel_m) {
  return under_cloud(textureLod(noise_tile, in_clouds(at_m), log2(max(pixel_m * (256.0 / kShadows_m), 1.0))).r);
}

// A direction that is turned from upright by this vector's length, toward it.
vec3 leaning(vec2 bend) {
  float angle = length(bend);
  float sine = angle > 1e-4 ? sin(angle) / angle : 1.0;
  return vec3(bend.x * sine, cos(angle), bend.y * sine);
}

// The share of blades that are drawn at a distance (Thinning::share).
float kept_share(float thinning, float distance_m) { return min(1.0, thinning * inversesqrt(distance_m) / distance_m); }

const float kGust = 0.5;  // a gust is seen by the light on it: more than its bend alone would show
const float kLawnGust = 0.8;  // and on a lawn

const float kSunInShadow = 0.16;  // leaves, threads and the air let some through

// The light of a blade at height t (0 foot, 1 tip) above its foot, where this share of the sunlight comes. `lean`: the
// sine of its chord; between upright blades the dark ground shows, of blades that the wind has bent one sees the lit
// sides, and neighbours bend alike.
vec3 blade_light(vec3 to_eye, vec3 along, vec3 normal, float t, vec3 tint, float lean, float shine, float sunlight) {
  vec3 sun = sun_light.rgb * sunlight;
  float facing = dot(normal, to_sun.xyz);
  float against = max(-dot(to_eye, to_sun.xyz), 0.0);
  float deep = smoothstep(0.0, 1.0, t);  // 0 in the shade of its neighbours, 1 in the light
  vec3 albedo = mix(grass_foot.rgb, tint, 0.12 + 0.88 * t);
  vec3 through = vec3(1.20, 1.05, 0.40) * albedo * (0.30 + 1.5 * against * against);
  vec3 sum = albedo * sky_light.rgb * (0.25 + 0.75 * deep) * (0.40 + 1.0 * max(normal.y, 0.0));
  sum += sun * (albedo * max(facing, 0.0) * 0.75 + through * max(-facing, 0.12) * 0.8) * (0.10 + 0.90 * deep);
  // A high sun comes down between the blades, and from one to the next.
  sum += sun * albedo * (0.55 * max(to_sun.y, 0.0) * deep);

  // A sheen along it, which makes the wind's waves visible.
  float sheen_side = dot(along, normalize(to_sun.xyz + to_eye));
  float sheen = max(1.0 - sheen_side * sheen_side, 0.0);
  sheen *= sheen;
  sheen *= sheen;
  sheen *= sheen;
  vec3 glint = sun * vec3(0.15, 0.155, 0.12) * shine * sheen * deep * (0.4 + 1.1 * (1.0 - along.y));
  // (It is all there where the sides are seen: what bends farther is no whiter.)
  float sides = exp2(4.0 * (lean - 0.60));
  return sum * sides + glint * min(sides, 1.0);
}

const float kShineFar = 0.35;  // of the sheen: blades lie in many directions

// The share of a lawn's light that is that of the grass as a whole, for its blades and for the ground between them: one sees no
// single blades of it.
float lawn_far(float distance_m) { return mix(0.62, 1.0, smoothstep(0.5, 6.0, distance_m)); }

// The share of a gust's light that is seen. Grass that leans shows its side, of which one sees less from above; but there it
// covers the dark ground, between upright blades.
float seen_from(vec3 to_eye) { return 1.0 - 0.35 * to_eye.y * to_eye.y; }

// How much more the grass is bent at a place than on the average: where a gust is.
float gust_of(vec2 bend) { return clamp(length(bend) - length(bend_mean.xy), -0.35, 0.45); }

// The light of grass as one sees it from afar: the upper parts of its blades, leaning with the wind. `tufts` from -0.5 to
// 0.5: how a tuft differs from its neighbours.
vec3 canopy_light(vec2 bend, vec3 to_eye, vec2 patch_at, float tufts, float tall, float sunlight) {
  vec3 along = leaning(bend * mix(0.35, 0.8, tall) + vec2(0.25, 0.1) * tufts);
  vec3 normal = normalize(vec3(to_eye.x, 0.35, to_eye.z) + vec3(along.x, 0.0, along.z) * 0.5);
  float gust = (0.42 + kGust) * seen_from(to_eye) * gust_of(bend);
  // As far as blades do: their own tilt and the wind's bend are seldom one way.
  float lean = mix(0.55 + kLawnGust * gust, clamp(length(vec2(0.42, 0.45 * length(bend_mean.xy))) + gust + 0.45 * tufts + 0.40 * patch_at.y, 0.0, 0.88), tall);
  vec3 light = blade_light(to_eye, along, normal, mix(0.72, 0.82, tall) + 0.3 * tufts, tint_of(patch_at, 0.5 + 0.8 * tufts), lean, kShineFar, sunlight);
  // From above one looks down between the blades.
  return light * (1.0 - tall * (0.15 + 0.30 * to_eye.y * to_eye.y * (1.0 - 0.6 * min(length(bend), 1.0))));
}
