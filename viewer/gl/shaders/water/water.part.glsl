// Water: the streamed waves, and ripples that are too small for their grid on them; sky and things mirrored in it, the
// bed seen through it, and the sun's glitter.
//
// Slopes are averaged over a pixel together with their squares, so that waves that are smaller than it still make it
// rough (M. Olano, D. Baker 2010, "LEAN mapping"); how much of the light a rough surface mirrors, and how the sun
// glitters on it, after E. Bruneton, F. Neyret, N. Holzschuch 2010, "Real-time realistic ocean lighting using seamless
// transitions from geometry to BRDF", with the slopes' distribution of C. Cox and W. Munk 1954.
uniform sampler2D slopes;   // along x, along z, and the sum of their squares
uniform sampler2D ripples;
uniform sampler2D mirror;
uniform float mirror_share; // of what is mirrored that is in the mirror: 1, or less where the water is small in the picture
uniform vec4 grid_place;    // x, z of the middle of the first texel's corner; size of a texel, metres; the water's height
uniform vec4 streaks;       // downwind; how far the surface has drifted, metres
uniform vec4 grid_axes;     // a matrix: from metres behind that place to parts of the grid's sides
uniform sampler2D noise_tile;
uniform float bed_lod;      // binary logarithm of its texels a metre
uniform sampler2D bed;      // the square root of its colors, as a light from straight above shows them
in vec3 place_m;
in float depth_m;
in vec4 water_state;        // how far it is woken, 0 to 1; how foamy; how rough the streamed waves are; what clouds let through of the sun
in vec3 down_light;         // the share of the light that comes down to the bed
in vec3 clear_sky;          // what level water mirrors where the mirror has nothing, a screen's value
in vec4 air_between;        // the light of the air before the water, and what it leaves of the water's own
in vec3 fires;              // their light
out vec4 color;

float level(float lod);            // at which a texture is looked up
float sun_on_water(vec3 place_m);  // the share of the sun's light that comes there

const float kMirrorMargin = 1.25;      // view.hpp
const float kRippleDeviation = 0.16;   // ripple_texture.hpp
const float kFineShare = 0.67;         // the slopes' variance that the grid cannot hold, over what it holds (ripple.cpp: 0.6 of all)
const float kMirrored_m = 60.0;        // about as far as what is mirrored: level water mirrors near things as exactly
const float kThroughCrest = 0.8;
const float kPi = 3.14159265;

vec2 ripple_at(vec2 at, float lod) { return (textureLod(ripples, at, level(lod)).rg - 0.5) / kRippleDeviation; }

void main() {
  vec3 ray = place_m - eye_m.xyz;
  float distance_m = length(ray);
  vec3 from_eye = ray / distance_m;
  float steep = max(-from_eye.y, 0.02);
  float pixel_lod = log2(eye_m.w * distance_m * inversesqrt(steep));  // of a pixel's size, metres

  vec2 uv = mat2(grid_axes.xy, grid_axes.zw) * (place_m.xz - grid_place.xy);
  vec3 waves = textureLod(slopes, uv, pixel_lod - log2(grid_place.z)).rgb;
  float rough = water_state.z;
  float paw = water_state.x;
  float fine = kFineShare * rough * mix(0.08, 4.5, paw);
  // Between the paws it is calmer.
  float calmed = mix(0.42, 1.15, paw);
  waves *= vec3(calmed, calmed, calmed * calmed);

  // Two layers of ripples run with the wind, one a little aside.
  float lod = pixel_lod + 7.27;  // 128 texels in 0.83 m
  vec2 drift_by = drift.xy * 60.0;
  vec2 ripple = ripple_at(place_m.xz / 0.83 - drift_by, lod) + ripple_at(mat2(0.8, 0.6, -0.6, 0.8) * place_m.xz / 0.51 - mat2(0.92, -0.38, 0.38, 0.92) * drift_by, lod + 0.7);
  float kept = 1.0 / (1.0 + exp2(2.0 * (lod - 2.0)));  // of their variance, on this level
  float strength = sqrt(0.25 * fine);
  vec2 slope = waves.xy + strength * ripple;
  float unseen = max(waves.z - dot(waves.xy, waves.xy), 0.0) + fine * (1.0 - kept) + 0.0002;

  vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
  float cosine = dot(normal, -from_eye);
  if (cosine < 0.04) {
    // One does not see the far side of a wave.
    normal = normalize(normal - from_eye * (0.04 - cosine));
    cosine = dot(normal, -from_eye);
  }
  float deviation = sqrt(0.5 * unseen);
  float mirrored = 0.02 + 0.98 * pow(1.0 - cosine, 5.0 * exp(-2.69 * deviation)) / (1.0 + 22.7 * (deviation * sqrt(deviation)));

  // What is mirrored. Of a rough surface one sees more of what is turned to the eye: it mirrors what is higher.
  vec3 up_ray = reflect(from_eye, normal);
  up_ray.y = abs(up_ray.y) + 2.0 * unseen + 1.2 * deviation * (1.0 - cosine);
  up_ray = normalize(up_ray);
  vec3 image = place_m + up_ray * kMirrored_m;
  image.y = 2.0 * grid_place.w - image.y;
  vec4 at = to_clip * vec4(image, 1.0);
  vec2 off = at.xy / max(at.w, 0.01) / kMirrorMargin;
  // A steep wave's image is drawn out.
  float spread = sqrt(0.5 * unseen + 0.06 * dot(slope, slope));
  float blur = log2(max(1.2 * spread * float(textureSize(mirror, 0).y) / (2.0 * up.w * kMirrorMargin), 1.0));
  vec3 sky = textureLod(mirror, 0.5 + 0.5 * off, level(min(blur, 4.0))).rgb;
  float beside = max(smoothstep(0.88, 1.0, max(abs(off.x), abs(off.y))), 1.0 - mirror_share);
  if (beside > 0.0 || at.w <= 0.01) sky = mix(sky, clear_sky, at.w > 0.01 ? beside : 1.0);

  // What is seen through it: the bed, and the light that the water itself scatters.
  float sun_there = sun_on_water(place_m);
  float lit = water_state.w * mix(0.15, 1.0, sun_there);
  const vec3 kAbsorbed = vec3(1.9, 0.85, 1.25);  // per metre
  vec3 down = refract(from_eye, normal, 0.752);
  float path_m = depth_m / max(-down.y, 0.35);
  vec3 left = exp(-kAbsorbed * path_m);
  vec3 sun = sun_light.rgb * lit * max(to_sun.y, 0.0);
  vec3 within = vec3(0.036, 0.050, 0.029) * (sky_light.rgb + 1.2 * sun) * (1.0 - left.g);
  // Waves gather the sun's light on the bed.
  float gathered = 1.0 + clamp(24.0 * (ripple.x + ripple.y) * strength, -0.4, 0.9) * smoothstep(0.02, 0.12, depth_m);
  vec2 bed_uv = uv + mat2(grid_axes.xy, grid_axes.zw) * (down.xz * path_m);
  vec3 earth = textureLod(bed, bed_uv, level(pixel_lod + bed_lod)).rgb;
  within += earth * earth * (sky_light.rgb + sun * gathered) * down_light * left;
  within += vec3(0.036, 0.050, 0.029) * fires * (1.0 - left.g);

  // A crest between the eye and the sun lets its light through: the more, the thinner it is.
  float crest = (place_m.y - grid_place.w) * inversesqrt(rough + 1e-4);
  float through = smoothstep(0.05, 0.40, crest) * max(dot(from_eye, to_sun.xyz), 0.0) * smoothstep(0.02, 0.20, length(slope));
  within += vec3(0.060, 0.130, 0.085) * sun_light.rgb * (lit * through * kThroughCrest);

  // Foam, torn into streaks along the wind.
  vec2 floats_m = place_m.xz - streaks.zw;
  vec2 in_wind_m = vec2(dot(floats_m, streaks.xy), dot(floats_m, vec2(-streaks.y, streaks.x)));
  float bubbles = textureLod(noise_tile, in_wind_m * vec2(1.1, 1.9) + 0.25 * slope, level(pixel_lod + 8.9)).r;
  float foam = smoothstep(0.0, 0.36, 0.45 * bubbles + water_state.y);

  // The sun's glitter, where the disc is seen from: the share of slopes that mirror it.
  vec3 half_way = normalize(to_sun.xyz - from_eye);
  vec2 from_mean = -half_way.xz / max(half_way.y, 0.05) - slope;
  float variance = 0.5 * unseen + 0.0006;
  float steepness = exp(-0.5 * dot(from_mean, from_mean) / variance) / (2.0 * kPi * variance);
  float missing = 1.0 - max(dot(half_way, to_sun.xyz), 0.0);
  float missing_2 = missing * missing;
  float glitter = (0.02 + 0.98 * missing_2 * missing_2 * missing) * steepness / (4.0 * half_way.y * half_way.y * half_way.y * half_way.y * max(cosine, 0.05));
  vec3 own = within * (1.0 - mirrored) + sun_light.rgb * (water_state.w * sun_there * to_sun.w * min(glitter * max(to_sun.y, 0.0) * kPi, 6.0));

  vec3 white = vec3(0.72) * (soft_light(normal) + sun_light.rgb * (lit * max(dot(normal, to_sun.xyz), 0.0)) + fires);
  own = mix(own, white, foam);
  mirrored *= 1.0 - foam;

  // The mirror has the screen's values: they are mixed as light, nearly.
  vec3 value = finish(own * air_between.a + air_between.rgb);
  value = sqrt(value * value + sky * sky * mirrored);
  color = vec4(dithered(min(value, 1.0), gl_FragCoord.xy), 1.0);
}
