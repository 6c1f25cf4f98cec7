// Put in front of every shader: what all renderers share. World: x east, y up, z south; metres. Light is linear until
// finish().

// GLSL 1.40 (OpenGL 3.1) has by extensions what the shaders need besides (viewer/gl/driver.hpp); GLSL ES 3.00 (a browser)
// wants every precision named.
#ifdef GL_ES
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DShadow;
precision highp sampler3D;
precision highp usampler2D;
#elif __VERSION__ < 330
#extension GL_ARB_explicit_attrib_location : require
#extension GL_ARB_shader_bit_encoding : require
#endif

// Arrays of numbers, and the element `at` of one: gl::TexelBuffer, a texture that is 1024 texels wide, row behind row.
#define Numbers sampler2D
#define WholeNumbers usampler2D
vec4 fetch(Numbers numbers, int at) { return texelFetch(numbers, ivec2(at & 1023, at >> 10), 0); }
uvec4 fetch(WholeNumbers numbers, int at) { return texelFetch(numbers, ivec2(at & 1023, at >> 10), 0); }

layout(std140) uniform View {
  mat4 to_clip;
  vec4 eye_m;    // w: size of a pixel at one metre's distance
  vec4 right;    // w: tangent of half the field of view, horizontally
  vec4 up;       // w: the same, vertically
  vec4 forward;  // w: how dense the mist is between the eye's height and the ground, on average; 1 on the ground
  mat4 to_shadow;  // to the shadow map
  vec4 shadow;     // a texel of it, 0: there is none; how a penumbra grows in it, across and upright; its depth, metres
};

// The light of the picture (described in viewer/light/light.hpp).
layout(std140) uniform Light {
  vec4 to_sun;        // toward the sun or, by night, the moon; how much of it is seen
  vec4 sun_light;     // its light
  vec4 sky_light;
  vec4 turf_light;
  vec4 zenith;        // the clear sky: overhead, at the horizon on the sun's side, and on the other
  vec4 horizon_near;
  vec4 horizon_far;
  vec4 glow_wide;     // around the sun
  vec4 glow_narrow;
  vec4 glow_disc;
  vec4 cloud_light;
  vec4 cloud_glow;
  vec4 sun_disc;      // w: how much of it is seen
  vec4 moon_disc;
  vec4 air;           // exposure; haze, per metre; where clouds begin; stars
  vec4 drift;         // of the clouds; how dark their shadows are; the noise above which there is one
  vec4 colors;        // how colorful the picture is, and what is dark in it; how tall grass may grow
  vec4 grass_lush;    // w: more straw above 0
  vec4 grass_fresh;   // w: how many flowers
  vec4 grass_straw;
  vec4 grass_foot;    // w: 1 / the width of the picture on the ground
  vec4 petals[3];
  vec4 leaves;        // factor; w: the share of them that hang
  vec4 woods;         // w: snow on hills
  vec4 earth;         // the bare ground; w: how uneven it looks
  vec4 turned_leaves; // factor on those that have turned the farthest
};

// The fires that are nearest to the eye (viewer/light/fire_light.hpp).
layout(std140) uniform Fires {
  vec4 fire_count;           // x
  vec4 fire_place_radius[4];
  vec4 fire_color[4];        // on a surface that faces it at one metre
};

// The light of fires on a surface; a flame is as high as wide things are near it, so that a little comes around edges.
vec3 fire_light(vec3 place_m, vec3 normal) {
  vec3 light = vec3(0.0);
  for (int i = 0; i < int(fire_count.x); ++i) {
    vec3 way = fire_place_radius[i].xyz - place_m;
    float square = dot(way, way);
    float radius = fire_place_radius[i].w;
    float facing = max(0.2 + 0.8 * dot(normal, way) * inversesqrt(square + 1e-6), 0.0);
    light += fire_color[i].rgb * (facing / (square + radius * radius));
  }
  return light;
}

// The light of the air along a unit direction, without clouds and hills: another at the horizon than above, and a glow
// around the sun.
vec3 air_light(vec3 direction) {
  float height = max(direction.y, 0.0);
  float side = 0.5 + 0.5 * dot(direction.xz, sun_disc.xz);
  vec3 light = mix(mix(horizon_far.rgb, horizon_near.rgb, side * side), zenith.rgb, 1.0 - exp(-6.0 * height));
  float near_sun = max(dot(direction, sun_disc.xyz), 0.0);
  float near_2 = near_sun * near_sun;
  float near_8 = near_2 * near_2 * near_2 * near_2;
  float near_32 = near_8 * near_8 * near_8 * near_8;
  float near_96 = near_32 * near_32 * near_32;
  float near_400 = near_96 * near_96 * near_96 * near_96;
  return light + glow_wide.rgb * near_8 + glow_narrow.rgb * near_96 + glow_disc.rgb * near_400;
}

// The share of a thing's light that the air replaces at a distance; 0 near the eye. For things near the ground.
float haze(float distance_m) { return 1.0 - exp(-max(distance_m - 3.0, 0.0) * air.y * forward.w); }

// The same of what is far and high, by color: mist gets thinner with height (C. Wenzel 2006, "Real-time atmospheric
// effects in games"), and clear air scatters more blue.
const float kMistHeight_m = 110.0;  // it is e times as thin there (view.cpp)
vec3 far_haze(vec3 place_m) {
  float rise = (place_m.y - eye_m.y) / kMistHeight_m;
  float density = exp(-eye_m.y / kMistHeight_m) * (abs(rise) < 1e-3 ? 1.0 : (1.0 - exp(-rise)) / rise);
  float distance_m = distance(place_m, eye_m.xyz);
  return 1.0 - exp(-distance_m * (air.y * density + vec3(2.0e-5, 3.0e-5, 5.5e-5)));
}

// The transfer curve of screens (IEC 61966-2-1, sRGB) of values from 0 to 1, to a hundredth, by square roots (I. Taylor
// 2012, "sRGB approximations for HLSL", chilliant.blogspot.com); near black it is straight.
vec3 screen_value(vec3 light) {
  vec3 root_2 = sqrt(light);
  vec3 root_4 = sqrt(root_2);
  vec3 root_8 = sqrt(root_4);
  vec3 curve = 0.662002687 * root_2 + 0.684122060 * root_4 - 0.323583601 * root_8 - 0.0225411470 * light;
  return mix(curve, 12.92 * light, lessThan(light, vec3(0.0031308)));
}

// Linear light to the screen's values: exposure, a filmic tone curve (K. Narkowicz 2015, "ACES filmic tone mapping
// curve"), and the screen's transfer curve.
vec3 finish(vec3 light) {
  vec3 x = light * air.x;
  // In the dark eyes see hardly any color, and what there is of it as bluish.
  float grey = dot(x, vec3(0.2126, 0.7152, 0.0722));
  float colorful = colors.x * mix(colors.y, 1.0, min(3.0 * grey, 1.0));
  x = mix(mix(vec3(grey), grey * vec3(0.80, 0.97, 1.45), 1.0 - colors.y), x, colorful);
  return screen_value(clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0));
}

// A number from 0 to 1 for each pixel, evenly spread: interleaved gradient noise (J. Jimenez 2014).
float pixel_chance(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// A screen's value, changed at random by half a step of 8 bits, so that no bands show in what changes slowly.
vec3 dithered(vec3 value, vec2 pixel) { return value + (pixel_chance(pixel) - 0.5) / 255.0; }

// The screen's value of a thing at a place that emits or reflects this light, seen through the air.
vec3 seen(vec3 light, vec3 place_m) {
  vec3 ray = place_m - eye_m.xyz;
  float distance_m = length(ray);
  // A level direction, shorter the steeper one looks down, so that from straight above there is no glow of the sun in
  // it.
  return finish(mix(light, air_light(vec3(ray.x / distance_m, 0.02, ray.z / distance_m)), haze(distance_m)));
}

// The light of the sky, and of the sky reflected by the turf, on a surface with this normal.
vec3 soft_light(vec3 normal) {
  return sky_light.rgb * (0.60 + 0.40 * normal.y) + turf_light.rgb * (0.5 - 0.5 * normal.y);
}

// The share of the sun's light that comes to a place, and is not held back by what stands between: 0 to 1. One look at the
// shadow map: for things that are small or many.
uniform sampler2DShadow shadow_map;
uniform sampler2D shadow_depth;

float sunlight_near(vec3 place_m) {
  if (shadow.x == 0.0) return 1.0;
  vec3 at = (to_shadow * vec4(place_m, 1.0)).xyz;
  if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return 1.0;
  return textureLod(shadow_map, vec3(at.xy, min(at.z, 1.0)), 0.0);  // things cast shadows beyond the map's far end, too
}

// The same with a penumbra that grows with the distance from what casts the shadow (R. Fernando 2005, "Percentage-closer
// soft shadows"). `chance`, 0 to 1, turns its samples, another way at each pixel.
float sunlight_at(vec3 place_m, float chance) {
  if (shadow.x == 0.0) return 1.0;
  if (shadow.y == 0.0) return sunlight_near(place_m);  // hard shadows
  vec3 at = (to_shadow * vec4(place_m, 1.0)).xyz;
  if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return 1.0;
  float depth = min(at.z, 1.0);
  float angle = 6.2831853 * chance;
  vec2 turn = vec2(cos(angle), sin(angle));
  mat2 turned = mat2(turn.x, turn.y, -turn.y, turn.x);
  const vec2 kSpiral[8] = vec2[8](vec2(0.25, 0.0), vec2(-0.32, 0.29), vec2(0.05, -0.56), vec2(0.40, 0.53),
                                  vec2(-0.74, -0.13), vec2(0.70, -0.45), vec2(-0.23, 0.84), vec2(-0.37, -0.92));
  vec2 widest = max(shadow.yz * 0.6, vec2(2.0 * shadow.x));
  float near = 0.0;
  float blocked = 0.0;
  for (int i = 0; i < 8; ++i) {
    float before = textureLod(shadow_depth, at.xy + turned * kSpiral[i] * widest, 0.0).r;
    float blocks = step(before, depth - 0.0005);
    near += before * blocks;
    blocked += blocks;
  }
  if (blocked == 0.0) return 1.0;
  vec2 wide = max(shadow.yz * (at.z - near / blocked), vec2(1.2 * shadow.x));
  float lit = 0.0;
  for (int i = 0; i < 8; ++i) lit += textureLod(shadow_map, vec3(at.xy + turned * kSpiral[i] * wide, depth), 0.0);
  return lit / 8.0;
}

// The share of the sun's light that clouds let through to a place on the ground. Their shadows go with the wind as fast as they
// do, but are smaller, so that one sees several at once.
uniform sampler2D cloud_noise;
const float kShadows_m = 300.0;  // after so far they repeat
const float kDrift_m = 1500.0;   // a height of the clouds (sky_keeper.cpp)
vec2 in_clouds(vec2 at_m) { return at_m * (1.0 / kShadows_m) - drift.xy * (kDrift_m / kShadows_m); }
float under_cloud(float cloud) { return 1.0 - drift.z * smoothstep(drift.w - 0.06, drift.w + 0.06, cloud); }

// The same for a place above the ground: it is in the shadow that the sun's ray through it meets on the ground.
float below_clouds(vec3 place_m) {
  if (drift.z == 0.0) return 1.0;
  vec2 on_ground_m = place_m.xz - to_sun.xz * (place_m.y / max(to_sun.y, 0.1));
  return under_cloud(textureLod(cloud_noise, in_clouds(on_ground_m), 0.0).r);
}

// Joints of strands as the forward kinematics writes them, in blocks of 16 strands.
uniform Numbers joints;  // first + ((strand / 16 * links + link) * 3 + axis) * 16 + strand % 16
uniform int links;

vec3 joint_at(int at) { return vec3(fetch(joints, at).r, fetch(joints, at + 16).r, fetch(joints, at + 32).r); }
vec3 joint(int first, uint strand, int link) {
  return joint_at(first + ((int(strand) >> 4) * links + link) * 48 + (int(strand) & 15));
}
