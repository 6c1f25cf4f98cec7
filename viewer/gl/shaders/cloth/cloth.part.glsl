// Woven cloth, lit from both sides and through. Each kind of cloth has a program of its own, which sews and paints it: a
// processor that draws would go through those of all.
uniform vec2 size_m;
uniform vec4 color_1;  // of the cloth; w: 1 where an installation wants it
uniform vec4 color_2;  // of its pattern
uniform bool has_picture;
uniform sampler2D picture;  // covers all of it

in vec3 place_m;
in vec3 normal;
in vec2 cloth_m;
in float clouds_let_through;  // of the sun's light
in float bend_per_m;  // above 0: hollow on the side of the normal
out vec4 color;

const float kFineFolds = 0.30;  // how far they lean, the tangent

float chance(float n) { return fract(sin(n * 12.9898) * 43758.5453); }

// 1 where `inside` is above 0, with an edge one pixel wide.
float cover(float inside) {
  float pixel = max(fwidth(inside), 1e-5);
  return smoothstep(-0.7 * pixel, 0.7 * pixel, inside);
}

// 1 on a line so wide around 0; fainter where it is narrower than a pixel.
float line(float beside_m, float width_m) {
  float pixel = max(fwidth(beside_m), 1e-6);
  return min(width_m / pixel, 1.0) * (1.0 - smoothstep(0.5 * width_m, 0.5 * width_m + pixel, abs(beside_m)));
}

// What plain woven cloth is like at a place: how its threads lean (xy, of the normal), and its brightness, about 1. Where
// threads are finer than pixels it is their mean, so that they make no moire.
vec3 weave(vec2 at_m, float thread_m) {
  vec2 thread = at_m / thread_m;
  vec2 blur = fwidth(thread);
  vec2 slub = vec2(chance(floor(thread.x)), chance(floor(thread.y) + 71.0)) - 0.5;
  vec2 bands = vec2(chance(floor(thread.x / 7.0) + 13.0), chance(floor(thread.y / 7.0) + 29.0)) - 0.5;
  vec2 uneven = 0.16 * slub * clamp(1.4 - 1.6 * blur, 0.0, 1.0) + 0.05 * bands * clamp(1.4 - 0.3 * blur, 0.0, 1.0);

  // Each thread goes over one and under the next.
  float near = clamp(1.5 - 2.5 * max(blur.x, blur.y), 0.0, 1.0);
  vec2 cell = floor(thread);
  vec2 in_cell = thread - cell - 0.5;
  vec2 lean = mod(cell.x + cell.y, 2.0) < 0.5 ? vec2(1.5, 0.5) * in_cell : vec2(0.5, 1.5) * in_cell;
  vec2 gap = smoothstep(0.30, 0.50, abs(in_cell));
  return vec3(near * lean, 1.0 + uneven.x + uneven.y - near * 0.22 * (gap.x + gap.y - 0.8));
}

// Wrinkles of about this width that lie across a way on the cloth: their slope along it, from -1 to 1. They begin and end,
// and none is as wide as the next.
float wrinkles(vec2 at_m, vec2 way, float width_m) {
  vec2 at = vec2(dot(at_m, way), dot(at_m, vec2(-way.y, way.x))) / width_m;
  float across = at.x + 0.9 * sin(0.37 * at.y + 1.9 * sin(0.23 * at.x)) + 0.3 * sin(0.83 * at.x - 0.61 * at.y);
  return cos(6.2831853 * across) * (0.55 + 0.45 * sin(0.47 * at.y + 1.3 * at.x));
}

// Seams at a hem so wide that ends `edge_m` away: its layers (x), the stitches along it (y), and the shade at its fold (z).
vec3 hem(float edge_m, float along_m, float width_m) {
  float from_seam_m = edge_m - (width_m - 0.0025);
  float stitches = smoothstep(0.15, 0.30, abs(fract(along_m / 0.006) - 0.5));
  stitches = mix(stitches, 0.7, clamp(fwidth(along_m) / 0.003, 0.0, 1.0));
  return vec3(cover(width_m - edge_m), line(from_seam_m, 0.0011) * stitches, line(edge_m - width_m - 0.0008, 0.0022));
}

// Is there nothing but the cloth's own colour?
bool is_plain() { return color_1.w > color_2.w; }
vec3 wanted(vec4 color, vec3 otherwise) { return mix(otherwise, color.rgb, color.w); }

// How a piece of cloth is made at a place.
struct Sewn {
  vec3 paint;
  vec3 seams;     // hem()
  float through;  // how much of the light comes through it
  float satin;    // how much it shines
  float thread_m;
  vec2 brass;      // of an eyelet: its ring and its hole
  float wrinkle_m;  // how wide its wrinkles are
};

// The cloth's light on the screen.
void show(Sewn sewn) {
  // The sun's map of depths needs no colour.
  if (shadow.x == 0.0 && shadow.w > 0.0) {
    color = vec4(0.0);
    return;
  }
  vec3 from_eye = normalize(place_m - eye_m.xyz);
  vec3 facing = normalize(normal);
  float side = dot(facing, from_eye) > 0.0 ? -1.0 : 1.0;
  facing *= side;

  vec3 paint = sewn.paint;
  vec3 seams = sewn.seams;
  vec2 brass = sewn.brass;
  float through = sewn.through;
  if (has_picture) paint = mix(vec3(0.012), vec3(0.78), texture(picture, cloth_m / size_m).rgb);
  vec3 threads = weave(cloth_m, sewn.thread_m);
  paint *= threads.z * (1.0 - 0.05 * seams.x) * (1.0 - 0.22 * seams.z);
  paint = mix(paint, min(paint * 1.25 + 0.03, 0.8), 0.6 * seams.y);
  through *= (1.0 - 0.45 * seams.x) * (1.0 - brass.x);
  paint = mix(paint, mix(vec3(0.55, 0.36, 0.10), vec3(0.01), brass.y), brass.x);

  // The threads' own lean, from the axes along which the cloth's places grow.
  vec2 right_m = vec2(dFdx(cloth_m.x), dFdy(cloth_m.x));
  vec2 down_m = vec2(dFdx(cloth_m.y), dFdy(cloth_m.y));
  vec3 along_x = dFdx(place_m) * down_m.y - dFdy(place_m) * down_m.x;
  vec3 along_y = dFdy(place_m) * right_m.x - dFdx(place_m) * right_m.y;
  float turned = right_m.x * down_m.y - right_m.y * down_m.x < 0.0 ? -1.0 : 1.0;
  vec3 leaning = threads.x * along_x * inversesqrt(dot(along_x, along_x) + 1e-30) + threads.y * along_y * inversesqrt(dot(along_y, along_y) + 1e-30);
  leaning *= 0.30;

  // Where the cloth is pressed together it wrinkles across that: a part of each length on it, by which it is shorter than it
  // lies flat (the strain between its joints), goes into wrinkles too small for them.
  float area = max(abs(right_m.x * down_m.y - right_m.y * down_m.x), 1e-20);
  vec3 per_x = along_x / area;
  vec3 per_y = along_y / area;
  float width_m = sewn.wrinkle_m;
  float seen_near = 1.0 - smoothstep(0.12, 0.40, max(length(right_m), length(down_m)) / width_m);
  const vec2 kWays[4] = vec2[4](vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(0.7071, 0.7071), vec2(0.7071, -0.7071));
  for (int i = 0; i < 4; ++i) {
    vec3 way = kWays[i].x * per_x + kWays[i].y * per_y;
    float pressed = seen_near * smoothstep(0.03, 0.45, 1.0 - length(way));
    if (pressed > 0.01) leaning += (0.34 * pressed * wrinkles(cloth_m + 0.37 * float(i), kWays[i], width_m)) * way;
  }
  facing = normalize(facing + turned * leaning);

  // Inside a fold comes less of the sky; the cloth's own light fills it again a little.
  float hollow = bend_per_m * side;
  float open = 1.0 - 0.60 * smoothstep(0.0, 45.0, hollow) + 0.10 * smoothstep(0.0, 45.0, -hollow);

  // The sun on this side; the sun through the threads from the other, strongest when one looks toward it; the sky on both.
  // What has come through threads has the cloth's colour, deeper.
  vec3 deep = paint * sqrt(max(paint, vec3(0.0))) * 1.25;
  float shade = sunlight_at(place_m + 0.04 * to_sun.xyz, pixel_chance(gl_FragCoord.xy));
  vec3 sun = sun_light.rgb * clouds_let_through * mix(0.5 * deep, vec3(1.0), shade);
  float height = dot(facing, to_sun.xyz);
  // Folds finer than the mesh lean either way: where the sun only grazes the cloth, some of it still falls on each side.
  float grazed = sqrt(height * height + kFineFolds * kFineFolds);
  float on = 0.5 * (grazed + height);
  float behind = 0.5 * (grazed - height);
  float against = max(dot(from_eye, to_sun.xyz), 0.0);
  float against_2 = against * against;
  vec3 light = paint * sun * (0.85 * on);
  light += deep * sun * (through * behind * (0.62 + 0.55 * against_2 * against_2));
  light += (paint * soft_light(facing) * 0.80 + deep * soft_light(-facing) * (0.70 * through)) * open;

  light += paint * (fire_light(place_m, facing) + 0.5 * through * fire_light(place_m, -facing));

  // Threads reflect more at a grazing angle, and tight ones shine.
  float rim = 1.0 - abs(dot(facing, from_eye));
  light += (0.25 + paint) * (sky_light.rgb * open + 0.35 * sun * on) * (0.22 * rim * rim * rim);
  float shine = max(dot(facing, normalize(to_sun.xyz - from_eye)), 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  light += (0.045 * sewn.satin + 0.5 * brass.x * (1.0 - brass.y)) * shine * on * sun;
  color = vec4(seen(light, place_m), 1.0);
}
