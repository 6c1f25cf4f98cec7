// A cloth's point, its normal, how much it is bent there, and its place on the cloth's picture, metres to the right of
// and below the upper left corner.
layout(location = 0) in float x_m;
layout(location = 1) in float y_m;
layout(location = 2) in float z_m;
layout(location = 3) in float normal_x;
layout(location = 4) in float normal_y;
layout(location = 5) in float normal_z;
layout(location = 6) in float bend;
layout(location = 7) in float right_m;
layout(location = 8) in float down_m;

out vec3 place_m;
out vec3 normal;
out vec2 cloth_m;
out float bend_per_m;
out float clouds_let_through;

void main() {
  place_m = vec3(x_m, y_m, z_m);
  normal = vec3(normal_x, normal_y, normal_z);
  cloth_m = vec2(right_m, down_m);
  bend_per_m = bend;
  clouds_let_through = below_clouds(place_m);
  gl_Position = to_clip * vec4(place_m, 1.0);
}
