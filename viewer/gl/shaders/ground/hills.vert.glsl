// A wall of the far country (viewer/meshes/far_country.hpp): its top, and its foot on the ground or behind the ground's end.
uniform Numbers corners;  // of the wall's top, metres; w: on the way around
uniform int range;              // 0 is the nearest
uniform int every;              // so manieth corner is drawn

const float kGroundEnd_m = 1400.0;  // the ground's sheet goes at least that far

out vec3 place_m;
out vec2 wall_m;  // along it and above the ground
out float top_m;  // its height there
out vec3 air_there;  // the air's light before it,
out vec3 hazed;      // and the share of it

void main() {
  vec4 top_along = fetch(corners, every * (gl_VertexID >> 1));
  bool is_on_ground = range < 2;
  float distance_m = length(top_along.xz);
  float foot_m = is_on_ground ? 0.0 : min(0.0, eye_m.y - eye_m.y / kGroundEnd_m * distance_m);
  place_m = vec3(top_along.x, (gl_VertexID & 1) == 1 ? top_along.y : foot_m, top_along.z);
  wall_m = vec2(top_along.w, place_m.y);
  top_m = max(top_along.y, 0.5);
  vec3 ray = place_m - eye_m.xyz;
  air_there = air_light(normalize(vec3(ray.x, 0.02 * length(ray), ray.z)));
  hazed = far_haze(place_m);

  // Nearer than the end of the depth range on the way to the eye; behind everything but the sky.
  gl_Position = to_clip * vec4(is_on_ground ? place_m : mix(eye_m.xyz, place_m, 1500.0 / distance_m), 1.0);
  if (!is_on_ground) gl_Position.z = gl_Position.w * (1.0 - 1e-6 * float(6 - range));
}
