// Sparks: each a short streak from where it was to where it is, nowhere thinner than a pixel.
layout(location = 0) in vec4 place_glow;
layout(location = 1) in vec4 before_radius;

out vec2 across_along;
out float glow;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 place = place_glow.xyz;
  float pixel_m = eye_m.w * distance(place, eye_m.xyz);
  float radius_m = max(before_radius.w, 0.75 * pixel_m);
  vec3 way = place - before_radius.xyz;
  vec3 to_eye = normalize(eye_m.xyz - place);
  vec3 aside = cross(way, to_eye);
  aside = dot(aside, aside) > 1e-12 ? normalize(aside) : right.xyz;
  vec3 along = cross(to_eye, aside);
  float half_way_m = 0.5 * abs(dot(way, along));
  float half_m = radius_m + half_way_m;
  place += aside * (corner.x * radius_m) + along * (corner.y * half_m) - 0.5 * way;
  across_along = corner;
  // What is drawn larger than it is is dimmer by as much, and gives no more light: sparks of a pixel, many of which cross a
  // place in a storm, would flash (WCAG 2.3.1: flame_flash_test.cpp).
  glow = place_glow.w * before_radius.w * (before_radius.w + half_way_m) / (radius_m * half_m);
  gl_Position = glow > 0.0 ? to_clip * vec4(place, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
