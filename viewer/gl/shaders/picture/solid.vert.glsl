layout(location = 0) in vec3 place;
layout(location = 1) in vec3 facing;
layout(location = 2) in vec3 paint;
layout(location = 3) in vec3 fibres;  // place along and across the grain, metres; how much of it, 0 to 1

// A turn about the vertical through `axis_m` (x, z): its sine, and its cosine less 1, so that (0, 0) is no turn.
uniform vec2 axis_m;
uniform vec2 turn;

out vec3 place_m;
out vec3 normal;
out vec3 tint;
out vec3 grained;

vec3 turned(vec3 way) {
  return way + vec3(turn.y * way.x - turn.x * way.z, 0.0, turn.x * way.x + turn.y * way.z);
}

void main() {
  vec3 axis = vec3(axis_m.x, 0.0, axis_m.y);
  place_m = axis + turned(place - axis);
  normal = turned(facing);
  tint = paint;
  grained = fibres;
  gl_Position = to_clip * vec4(place_m, 1.0);
}
