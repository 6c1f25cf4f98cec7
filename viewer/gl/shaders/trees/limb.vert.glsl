// The short-haired parts of an animal.
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 facing;
layout(location = 2) in vec3 paint;
layout(location = 3) in vec2 hair;  // along the hairs and across them, metres
layout(location = 4) in vec3 aside; // from a hair's middle line, metres
uniform float wider;                // so many times as wide is a hair, where it stands for several

out vec3 place_m;
out vec3 normal;
out vec3 tint;
out vec2 hair_m;

void main() {
  place_m = place + (wider - 1.0) * aside;
  normal = facing;
  tint = paint;
  hair_m = hair;
  gl_Position = to_clip * vec4(place_m, 1.0);
}
