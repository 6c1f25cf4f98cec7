// The skin under a coat, a little below the hairs' roots.
uniform vec3 body_middle_m;
uniform mat3 body_shape;
layout(location = 0) in vec3 place;

out vec3 place_m;
out vec3 normal;

void main() {
  normal = normalize(body_shape * (place - body_middle_m));
  place_m = place - 0.004 * normal;
  gl_Position = to_clip * vec4(place_m, 1.0);
}
