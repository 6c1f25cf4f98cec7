layout(location = 0) in vec3 place;
layout(location = 1) in vec3 facing;
layout(location = 2) in vec3 paint;

out vec3 place_m;
out vec3 normal;
out vec3 tint;

void main() {
  place_m = place;
  normal = facing;
  tint = paint;
  gl_Position = to_clip * vec4(place, 1.0);
}
