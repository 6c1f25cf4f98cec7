#include "sward.part.glsl"
// A reed: a ribbon that leans and droops, and bends with the grass around. Some bear a brown head.
uniform int first_corner;
uniform int rings;
uniform Numbers reeds;  // two texels each: root, length, metres; heading, lean, radians, width, metres, chance

out vec3 shade;

void main() {
  int number = first_corner + gl_VertexID;
  int reed = number >> 8;
  vec4 root_length = fetch(reeds, 2 * reed);
  vec4 traits = fetch(reeds, 2 * reed + 1);
  int ring = (number & 255) >> 1;
  float side = float(number & 1) * 2.0 - 1.0;
  float t = float(ring) / float(rings);
  bool is_mace = traits.w > 0.90;
  vec2 heading = vec2(sin(traits.x), -cos(traits.x));
  float stiff = is_mace ? 0.35 : 1.0;
  vec2 bend = (bend_at(root_length.xz) * (0.30 + 0.25 * traits.w) + heading * 0.9 * traits.y) * stiff;
  vec2 tilt = heading * traits.y * stiff;
  float near_m = distance(eye_m.xyz, root_length.xyz + vec3(0.0, 0.5 * root_length.w, 0.0));
  float length_m = root_length.w * (is_mace ? 1.12 : 1.0) * smoothstep(0.7, 1.5, near_m);  // none in the eye
  vec3 place = root_length.xyz + length_m * t * leaning(tilt + bend * (0.5 * t));
  vec3 along = leaning(tilt + bend * max(t, 0.15));

  vec3 to_eye = eye_m.xyz - place;
  float distance_m = length(to_eye);
  to_eye /= distance_m;
  float profile = min(1.0, 3.5 * (1.0 - t)) * (0.7 + 0.6 * t * (1.0 - t));
  float head = 0.0;
  if (is_mace) {
    head = smoothstep(0.77, 0.80, t) * (1.0 - smoothstep(0.93, 0.95, t));
    profile = 0.32 + 1.1 * head;
  }
  vec3 across_eye = normalize(cross(along, to_eye));
  vec3 grown = vec3(cos(traits.x * 3.0), 0.0, sin(traits.x * 3.0));
  grown *= dot(grown, across_eye) < 0.0 ? -1.0 : 1.0;
  vec3 across = normalize(mix(across_eye, grown, is_mace ? 0.0 : 0.45));
  float half_width_m = max(0.5 * traits.z * profile, 0.50 * eye_m.w * distance_m * min(1.0, 4.0 * (1.0 - t)));
  place += across * (side * half_width_m);
  gl_Position = to_clip * vec4(place, 1.0);

  // Greyish green over a pale, dry foot; some have dried.
  float dry = smoothstep(0.62, 0.80, fract(traits.w * 7.3 + traits.x));
  vec3 tint = mix(mix(vec3(0.155, 0.150, 0.062), vec3(0.068, 0.118, 0.034), smoothstep(0.0, 0.35, t)), vec3(0.29, 0.235, 0.12), 0.8 * dry);
  tint = mix(tint * (0.75 + 0.5 * fract(traits.w * 61.0)), vec3(0.085, 0.042, 0.018), head);
  vec3 normal = normalize(cross(across, along));
  normal *= dot(normal, to_eye) < 0.0 ? -1.0 : 1.0;
  float lit = below_clouds(place) * mix(0.15, 1.0, sunlight_near(place));
  float facing = dot(normal, to_sun.xyz);
  float against = max(-dot(to_eye, to_sun.xyz), 0.0);
  float deep = 0.35 + 0.65 * smoothstep(0.0, 0.5, t);
  vec3 sum = tint * soft_light(vec3(0.0, 1.0, 0.0)) * 0.75;
  sum += tint * sun_light.rgb * lit * (0.75 * max(facing, 0.0) + (1.0 - head) * vec3(1.15, 1.05, 0.45) * max(-facing, 0.12) * (0.28 + 0.62 * against * against));
  sum += tint * fire_light(place, vec3(0.0, 0.7, 0.0) + 0.5 * to_eye);
  shade = seen(sum * deep, place);
}
