// Put in front of every shader: what all renderers share. World: x east, y up, z south; metres. Light is linear until
// finish().

layout(std140) uniform View {
  mat4 to_clip;
  vec4 eye_m;    // w: size of a pixel at one metre's distance
  vec4 right;    // w: tangent of half the field of view, horizontally
  vec4 up;       // w: the same, vertically
  vec4 forward;
  vec4 to_sun;
  vec4 field;    // x, z of the low and the high corner of the field
};

const vec3 kSunLight = vec3(3.9, 2.55, 1.30);
const vec3 kSkyLight = vec3(0.46, 0.55, 0.74);

// The light of the air along a unit direction, without clouds and hills: warm at the horizon, blue above, a glow around
// the sun.
vec3 air_light(vec3 direction) {
  float height = max(direction.y, 0.0);
  vec3 light = mix(vec3(0.66, 0.49, 0.36), vec3(0.10, 0.22, 0.47), 1.0 - exp(-6.0 * height));
  float near_sun = max(dot(direction, to_sun.xyz), 0.0);
  float near_2 = near_sun * near_sun;
  float near_8 = near_2 * near_2 * near_2 * near_2;
  float near_32 = near_8 * near_8 * near_8 * near_8;
  float near_96 = near_32 * near_32 * near_32;
  float near_400 = near_96 * near_96 * near_96 * near_96;
  return light + vec3(0.44, 0.20, 0.04) * near_8 + vec3(0.55, 0.36, 0.15) * near_96 + vec3(1.1, 0.85, 0.5) * near_400;
}

// The share of a thing's light that the air replaces at a distance; 0 near the eye.
float haze(float distance_m) { return 1.0 - exp(-max(distance_m - 3.0, 0.0) * 0.0075); }

// Linear light to the screen's values: a filmic tone curve (K. Narkowicz 2015, "ACES filmic tone mapping curve"), then
// the screen's transfer curve, approximated by a square root.
vec3 finish(vec3 light) {
  vec3 x = light * 0.62;
  return sqrt(clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0));
}

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
  return kSkyLight * (0.60 + 0.40 * normal.y) + vec3(0.16, 0.15, 0.05) * (0.5 - 0.5 * normal.y);
}

// Joints of strands as the forward kinematics writes them, in blocks of 16 strands.
uniform samplerBuffer joints;  // first + ((strand / 16 * links + link) * 3 + axis) * 16 + strand % 16
uniform int links;

vec3 joint_at(int at) { return vec3(texelFetch(joints, at).r, texelFetch(joints, at + 16).r, texelFetch(joints, at + 32).r); }
vec3 joint(int first, uint strand, int link) {
  return joint_at(first + ((int(strand) >> 4) * links + link) * 48 + (int(strand) & 15));
}
