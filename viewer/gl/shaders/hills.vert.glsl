// Ranges of hills at the horizon, one instance each, the nearest (and darkest) first: a strip all around, from the foot
// to the top.
const int kSteps = 2160;
const int kLines = 3;
const float kPi = 3.14159265;

out vec3 shade;

// The height of a range at a bearing, as a tangent; periodic around the circle.
float height(float bearing, float seed) {
  float h = sin(bearing * 3.0 + seed) + 0.55 * sin(bearing * 7.0 + seed * 2.3) + 0.30 * sin(bearing * 13.0 + seed * 4.1);
  return 0.62 + 0.26 * (h + 0.12 * sin(bearing * 29.0 + seed * 1.7) + 0.05 * sin(bearing * 61.0 + seed * 3.1));
}

void main() {
  float nearness = 1.0 - float(gl_InstanceID) / float(kLines - 1);
  float bearing = float(gl_VertexID >> 1) * 2.0 * kPi / float(kSteps);
  bool is_top = (gl_VertexID & 1) == 1;
  float top = mix(0.094, 0.030, nearness) * height(bearing, 1.3 + 2.9 * float(kLines - 1 - gl_InstanceID));

  // Crowns of trees on the nearest.
  top += nearness * nearness * 0.0028 * (abs(sin(bearing * 149.0)) + abs(sin(bearing * 233.0 + 1.0)) * sin(bearing * 31.0));
  vec3 direction = vec3(sin(bearing), is_top ? top : -0.002, -cos(bearing));
  gl_Position = to_clip * vec4(eye_m.xyz + direction * 1000.0, 1.0);
  gl_Position.z = gl_Position.w * (1.0 - 1e-5 * (1.0 + nearness));  // behind everything but the sky; near ranges before far ones

  // Less green with distance; mist at the foot.
  vec3 air = air_light(normalize(vec3(direction.x, 0.015, direction.z)));
  vec3 paint = mix(vec3(0.28, 0.31, 0.40), vec3(0.076, 0.127, 0.068), nearness);
  vec3 hill = mix(air, paint * sky_light.rgb, 0.42 + 0.36 * nearness);
  shade = finish(is_top ? hill : mix(hill, air, 0.75));
}
