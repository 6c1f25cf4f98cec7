// A cloth as it lies in its shadow on a floor: where there is no shadow map.
layout(location = 0) in float x_m;
layout(location = 1) in float y_m;
layout(location = 2) in float z_m;

uniform vec3 middle_m;  // of the floor

out vec3 place_m;
out vec3 normal;

void main() {
  float above_m = y_m - middle_m.y;
  place_m = vec3(x_m, y_m, z_m) - to_sun.xyz * (above_m / max(to_sun.y, 0.02));
  normal = vec3(0.0, 1.0, 0.0);
  // A sun on the horizon or below casts none.
  gl_Position = to_sun.y > 0.02 ? to_clip * vec4(place_m, 1.0) : vec4(0.0, 0.0, 2.0, 1.0);
}
