layout(location = 0) in vec3 rest;     // x, z, metres; the height of the bed
layout(location = 1) in float high_m;

out vec3 place_m;
out float bed_m;

void main() {
  place_m = vec3(rest.x, high_m, rest.y);
  bed_m = rest.z;
  gl_Position = to_clip * vec4(place_m, 1.0);
}
