#include "foliage.part.glsl"
// The leaves and branches in the picture of a far tree, in the light of now: the same light as leaf.vert.glsl
// computes, by the place in a round crown instead of each leaf's own.
uniform sampler2D looks;   // the square root of what is reflected, less the palette's factor
uniform sampler2D facing;  // the normal; below one half: wood, above: leaves, and how much light comes to them
uniform int kind;          // SprayShape::Kind
uniform float side_px;     // of a picture

in vec2 at;
in vec3 place_m;
flat in vec3 toward;
flat in vec3 turn_side;
flat in vec2 row_share;
flat in vec2 hanging_chance;
flat in float lower_share;
out vec4 color;

void main() {
  float chance = pixel_chance(gl_FragCoord.xy);
  if (fract(chance + 0.37) >= row_share.y) discard;
  if (kind == 2 && fract(chance + 0.71) >= hanging_chance.x) discard;
  // Between two pictures there is a narrow band in which both are seen.
  float side = mod(floor(turn_side.z) + step(chance, smoothstep(0.35, 0.65, fract(turn_side.z))), 8.0);
  float row = min(floor(row_share.x) + step(chance, smoothstep(0.35, 0.65, fract(row_share.x))), 2.0);
  vec2 texels = side_px * 0.5 * max(abs(dFdx(at)), abs(dFdy(at)));
  float level = clamp(log2(max(max(texels.x, texels.y), 1.0)) - 0.5, 0.0, 5.0);
  vec2 inside = clamp(at * 0.5 + 0.5, 0.5 * exp2(level) / side_px, 1.0 - 0.5 * exp2(level) / side_px);
  vec2 place = (vec2(side, row) + inside) / vec2(8.0, 3.0);
  vec4 look = textureLod(looks, place, level);
  if (look.a < 0.03) discard;
  vec4 shape = textureLod(facing, place, level) / look.a;
  vec3 paint = look.rgb / look.a;
  paint *= paint;
  float is_leaf = clamp(4.0 * shape.w - 1.0, 0.0, 1.0);
  // Twigs are thinner than a texel: of the pixels as many are drawn as they cover.
  if (look.a < mix(0.33, kind == 2 ? 1.5 * fract(chance + 0.19) : 0.33, is_leaf)) discard;
  float open = mix(0.5, clamp(2.0 * shape.w - 1.0, 0.0, 1.0), is_leaf);
  if (kind == 0) {
    // Leaves fall a few texels at a time.
    if (hanging_chance.x < 1.0 && is_leaf > 0.3) {
      uvec2 cell = uvec2(inside * side_px / max(3.0, 1.5 * exp2(level))) + uvec2(97.0 * side, 31.0 * row + 509.0 * hanging_chance.y);
      uint mixed_up = (cell.x * 1664525u + cell.y) * 22695477u + 1u;
      mixed_up = (mixed_up ^ (mixed_up >> 15u)) * 2654435769u;
      if (hangs(hanging_chance.x, float(mixed_up >> 8u) / 16777216.0) < 0.5) discard;
    }
    float twig = abs(abs(2.0 * fract(1.4 * at.x + 6.4 * hanging_chance.y) - 1.0) - abs(2.0 * fract(1.75 * at.y + 0.48 * side) - 1.0));
    paint *= mix(vec3(1.0), palette_of(hanging_chance.y, twig, open), is_leaf);
    paint = mix(paint, lower_face(paint), is_leaf * lower_share);
  }
  // The mean of the leaves of a pixel: the shorter, the more they differ.
  vec3 normal = shape.xyz * 2.0 - 1.0;
  normal = vec3(turn_side.x * normal.x - turn_side.y * normal.z, normal.y, turn_side.y * normal.x + turn_side.x * normal.z);

  // Where in the crown: a ball.
  vec3 right = vec3(toward.z, 0.0, -toward.x) * inversesqrt(max(dot(toward.xz, toward.xz), 1e-6));
  float depth = sqrt(max(1.0 - dot(at, at), 0.0));
  vec3 outward = normalize(at.x * right + at.y * cross(toward, right) + (0.2 + depth) * toward);
  vec3 sun = sun_light.rgb * below_clouds(place_m);
  float sun_seen = clamp(open * (0.32 + 0.95 * open + 0.55 * dot(outward, to_sun.xyz)), 0.02, 1.0);
  float sky_seen = clamp(open * (1.0 + 0.45 * outward.y), 0.32, 1.0);
  vec3 sum = paint * soft_light(normal) * sky_seen;
  float facing_sun = dot(normal, to_sun.xyz);
  float differ = sqrt(facing_sun * facing_sun + 0.25 * max(1.0 - dot(normal, normal), 0.0));
  float against = max(-dot(toward, to_sun.xyz), 0.0);
  vec3 through_leaf = (kind == 0 ? paint * vec3(0.95, 1.25, 0.35) : paint) * (kind == 2 ? 0.0 : is_leaf);
  vec3 sunlit = paint * (0.5 * (differ + facing_sun)) + through_leaf * (0.5 * (differ - facing_sun) * (0.95 + 1.1 * against * against * against));
  sum += sun * sun_seen * sunlit;
  sum += sun * (0.35 * paint + 0.65 * through_leaf) * (0.42 * (0.10 + 0.30 * sun_seen) * is_leaf);
  color = vec4(seen(sum, place_m), 1.0);
}
