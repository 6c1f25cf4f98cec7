// The skin around the body of a flame: where rays enter it.
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 at;

out vec3 place_m;
out vec3 inside;  // east and south of the middle of its row, metres; the part of the way from foot to top

void main() {
  place_m = place;
  inside = at;
  gl_Position = to_clip * vec4(place, 1.0);
}
