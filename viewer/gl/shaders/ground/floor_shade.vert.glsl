// A cloth as it lies in its shadow on a floor: where there is no shadow map.
layout(location = 0) in float x_m;
layout(location = 1) in float y_m;
layout(location = 2) in float z_m;
layout(location = 3) in float normal_x;
layout(location = 4) in float normal_y;
layout(location = 5) in float normal_z;

uniform vec3 middle_m;  // of the floor

out vec3 place_m;
out vec3 normal;
out float unshaded;
out float thin;

void main() {
  float above_m = y_m - middle_m.y;
  place_m = vec3(x_m, y_m, z_m) - to_sun.xyz * (above_m / max(to_sun.y, 0.02));
  normal = vec3(0.0, 1.0, 0.0);
  unshaded = 0.0;
  // The more aslant the light goes through the threads, the less is left of it.
  float straight = abs(dot(vec3(normal_x, normal_y, normal_z), to_sun.xyz));
  thin = 0.25 + 0.85 * straight;
  // A sun on the horizon or below casts none.
  gl_Position = to_sun.y > 0.02 ? to_clip * vec4(place_m, 1.0) : vec4(0.0, 0.0, 2.0, 1.0);
}
