// Woven cloth, lit from both sides and through: plain linen, a flag, a banner.
uniform int style;  // 0 curtain, 1 flag, 2 banner
uniform vec2 size_m;

in vec3 place_m;
in vec3 normal;
in vec2 cloth_m;
out vec4 color;

const vec3 kInk = vec3(0.012, 0.032, 0.125);
const vec3 kVermilion = vec3(0.56, 0.055, 0.020);
const vec3 kGold = vec3(0.86, 0.42, 0.045);
const vec3 kSnow = vec3(0.70, 0.67, 0.60);
const vec3 kLinen = vec3(0.66, 0.57, 0.43);

float chance(float n) { return fract(sin(n * 12.9898) * 43758.5453); }

// 1 where `inside` is above 0, with an edge one pixel wide.
float cover(float inside) {
  float pixel = max(fwidth(inside), 1e-5);
  return smoothstep(-0.7 * pixel, 0.7 * pixel, inside);
}

// The brightness of woven threads of uneven thickness, about 1; where they are finer than a pixel, their mean.
float weave(vec2 at_m, float thread_m) {
  vec2 thread = at_m / thread_m;
  vec2 blur = fwidth(thread);
  vec2 slub = vec2(chance(floor(thread.x)), chance(floor(thread.y) + 71.0)) - 0.5;
  slub += 0.5 * (vec2(chance(floor(thread.x / 7.0) + 13.0), chance(floor(thread.y / 7.0) + 29.0)) - 0.5);
  vec2 round_thread = 0.5 - abs(fract(thread) - 0.5);
  vec2 plain = (0.34 * slub + 0.35 * (round_thread - 0.25)) * clamp(1.6 - blur, 0.0, 1.0);
  return 1.0 + plain.x + plain.y;
}

// A golden sun behind three gusts on a dark blue sky. Unit: the flag's height.
vec3 flag(vec2 p, float aspect) {
  vec3 paint = mix(kInk * 1.25, kInk * 0.75, p.y);
  paint = mix(paint, kGold, cover(0.235 - length(p - vec2(0.40 * aspect, 0.45))));
  for (int i = 0; i < 3; ++i) {
    float n = float(i);
    float swing = 0.065 * sin(4.6 * p.x / aspect * 1.35 + 1.1 * n + 0.4) + 0.018 * sin(11.0 * p.x / aspect + 2.0 * n);
    float along = clamp(p.x / aspect, 0.0, 1.0);
    float begins = 0.10 + 0.07 * n;
    float half_width = (0.034 - 0.006 * n) * smoothstep(begins, begins + 0.35, along) * smoothstep(1.0, 0.72 - 0.08 * n, along);
    float line = half_width - abs(p.y - (0.545 + 0.125 * n + swing));
    paint = mix(paint, kSnow, cover(line) * step(0.0005, half_width));
  }
  return paint;
}

// White, with a red head, a crest of three gusts, and a dark blue foot of waves. Unit: the banner's width.
vec3 banner(vec2 p, float tall) {
  vec3 paint = kSnow;
  paint = mix(paint, kVermilion, cover(0.36 - p.y));
  paint = mix(paint, kSnow, cover(0.022 - abs(p.y - 0.29)));

  vec2 from_crest = p - vec2(0.5, 0.92);
  float radius = length(from_crest);
  float turn = atan(from_crest.y, from_crest.x);
  float gusts = sin(3.0 * turn - 15.0 * radius);
  paint = mix(paint, kInk, cover(0.355 - radius));
  paint = mix(paint, kSnow, cover(0.30 - radius) * cover(gusts * (0.12 + radius)));
  paint = mix(paint, kVermilion, cover(0.055 - radius));

  for (int i = 0; i < 3; ++i) {
    float n = float(i);
    float foot = tall - 1.15 + 0.30 * n + 0.055 * sin(6.2832 * (p.x * 1.5 + 0.31 * n));
    paint = mix(paint, i == 1 ? kSnow : kInk, cover(p.y - foot));
  }
  float stem = 0.030 * smoothstep(1.36, 2.1, p.y) * smoothstep(tall - 1.34, tall - 1.9, p.y);
  float thread = stem - abs(p.x - 0.5 - 0.11 * sin(2.6 * p.y + 0.6));
  paint = mix(paint, kVermilion, cover(thread) * step(1.36, p.y) * step(p.y, tall - 1.34));
  return paint;
}

void main() {
  vec3 from_eye = normalize(place_m - eye_m.xyz);
  vec3 facing = normalize(normal);
  facing *= dot(facing, from_eye) > 0.0 ? -1.0 : 1.0;

  // Distance to the nearest free edge: hems are two layers and let less light through.
  vec2 inside_m = min(cloth_m, size_m - cloth_m);
  float edge_m = min(inside_m.x, inside_m.y);
  vec3 paint;
  float through;
  float thread_m = 0.0035;
  if (style == 0) {
    float hem = max(cover(0.018 - inside_m.x), cover(0.055 - (size_m.y - cloth_m.y)));
    hem = max(hem, cover(0.05 - cloth_m.y));
    float seam = cover(0.0035 - abs(size_m.y - cloth_m.y - 0.055));
    paint = kLinen * (1.0 - 0.10 * hem) * (1.0 - 0.25 * seam);
    through = 0.80 - 0.34 * hem;
    thread_m = 0.005;
  } else if (style == 1) {
    paint = flag(cloth_m / size_m.y, size_m.x / size_m.y);
    paint *= 1.0 - 0.18 * cover(0.015 - edge_m);
    through = 0.52;
  } else {
    paint = banner(cloth_m / size_m.x, size_m.y / size_m.x);
    paint *= 1.0 - 0.14 * cover(0.012 - edge_m);
    through = 0.62;
  }
  float threads = weave(cloth_m, thread_m);
  paint *= threads;

  // The sun on this side; the sun through the threads from the other, strongest when one looks toward it; the sky.
  float sun = dot(facing, to_sun.xyz);
  float against = max(dot(from_eye, to_sun.xyz), 0.0);
  float on = max(sun, 0.0);
  float behind = max(-sun, 0.0);
  vec3 lit = paint * sun_light.rgb * 0.80 * on;
  vec3 glow = paint * sqrt(max(paint, vec3(0.0))) * sun_light.rgb * through * behind * (0.30 + 0.70 * behind) *
              (0.42 + 0.40 * against * against);
  vec3 light = lit + glow + paint * (soft_light(facing) * 0.85 + sun_light.rgb * 0.035);

  light += paint * (fire_light(place_m, facing) + 0.5 * through * fire_light(place_m, -facing));

  // Threads reflect more at a grazing angle.
  float rim = 1.0 - abs(dot(facing, from_eye));
  light += paint * (sky_light.rgb + 0.25 * sun_light.rgb * max(sun, 0.0)) * 0.35 * rim * rim * rim;
  color = vec4(seen(light, place_m), 1.0);
}
