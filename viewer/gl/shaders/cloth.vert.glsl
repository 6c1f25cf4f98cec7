// A cloth's joint, its normal, and its place on the cloth's picture, metres to the right of and below the upper left
// corner.
uniform int stride;
uniform vec2 origin_m;
uniform vec2 per_column_m;
uniform vec2 per_row_m;

layout(location = 0) in float x_m;
layout(location = 1) in float y_m;
layout(location = 2) in float z_m;
layout(location = 3) in float normal_x;
layout(location = 4) in float normal_y;
layout(location = 5) in float normal_z;

out vec3 place_m;
out vec3 normal;
out vec2 cloth_m;

void main() {
  place_m = vec3(x_m, y_m, z_m);
  normal = vec3(normal_x, normal_y, normal_z);
  cloth_m = origin_m + float(gl_VertexID % stride) * per_column_m + float(gl_VertexID / stride) * per_row_m;
  gl_Position = to_clip * vec4(place_m, 1.0);
}
