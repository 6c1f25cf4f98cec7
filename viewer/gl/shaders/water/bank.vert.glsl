layout(location = 0) in vec3 place;
layout(location = 1) in vec3 facing;
layout(location = 2) in float rim;

out vec3 place_m;
out vec3 normal;
out float edge;

void main() {
  place_m = place;
  normal = facing;
  edge = rim;
  gl_Position = to_clip * vec4(place, 1.0);
}
