// The ground that a pond and its bank take away, at the ground's height.
layout(location = 0) in vec3 place;
layout(location = 2) in float rim;

out vec2 at_m;
out float edge;

void main() {
  at_m = place.xz;
  edge = rim;
  gl_Position = to_clip * vec4(place.x, 0.0, place.z, 1.0);
}
