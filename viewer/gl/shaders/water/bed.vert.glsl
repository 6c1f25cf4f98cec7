// A pond's bed on a map of it.
layout(location = 0) in vec3 rest;     // x, z, metres; the height of the bed

uniform vec4 grid_place;    // as in water.part.glsl
uniform vec4 grid_axes;

out vec3 bed_at_m;

void main() {
  bed_at_m = vec3(rest.x, rest.z - grid_place.w, rest.y);
  vec2 uv = mat2(grid_axes.xy, grid_axes.zw) * (rest.xy - grid_place.xy);
  gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
}
