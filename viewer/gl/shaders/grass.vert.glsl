// A blade: a ribbon along a strand's joints, two vertices a joint, with its light.
uniform int rings;             // of vertices above the root: at most links; fewer where the blade is far away

layout(location = 0) in vec4 root_width;    // metres
layout(location = 1) in vec4 tint_facing;   // the tip's colour; the bearing of the blade's flat side, radians
layout(location = 2) in uint strand;

out vec3 shade;  // the screen's value; blades are so small that one for each vertex is exact enough

void main() {
  // This ring's joint, and the one below (for the root, the one above).
  int ring = gl_VertexID >> 1;
  float side = float(gl_VertexID & 1) * 2.0 - 1.0;
  int link = ring * links / rings;
  int link_below = (ring - 1) * links / rings;
  vec3 place = ring > 0 ? joint(0, strand, link - 1) : root_width.xyz;
  vec3 along = ring > 1 ? place - joint(0, strand, link_below - 1) : (ring > 0 ? place : joint(0, strand, links / rings - 1)) - root_width.xyz;
  along = normalize(along);
  float t = float(ring) / float(rings);

  // The flat side faces the blade's own bearing, turned half way to the eye, so that no blade is seen edge-on.
  vec3 to_eye = eye_m.xyz - place;
  float distance_m = length(to_eye);
  to_eye /= distance_m;
  vec3 across_eye = normalize(cross(along, to_eye));
  vec3 grown = vec3(cos(tint_facing.w), 0.0, sin(tint_facing.w));
  grown *= dot(grown, across_eye) < 0.0 ? -1.0 : 1.0;
  vec3 across = normalize(mix(across_eye, grown, 0.45));

  // Widest above the foot, pointed at the tip; nowhere else thinner than a pixel.
  float half_width = 0.5 * root_width.w * (0.72 + 0.85 * t) * sqrt(1.0 - t) * (1.0 - 0.35 * t * t);
  half_width = max(half_width, 0.42 * eye_m.w * distance_m * min(1.0, 4.0 * (1.0 - t)));
  place += across * (side * half_width);
  gl_Position = to_clip * vec4(place, 1.0);

  // A blade is folded along its middle: the normals of its two edges differ a little.
  vec3 normal = normalize(cross(across, along));
  normal *= dot(normal, to_eye) < 0.0 ? -1.0 : 1.0;
  normal = normalize(normal + across * (side * 0.55));

  // Light: the sun on this side or through the blade, the sky, and a sheen along it, which makes the wind's waves
  // visible.
  float facing = dot(normal, to_sun.xyz);
  float against = max(-dot(to_eye, to_sun.xyz), 0.0);
  float deep = smoothstep(0.0, 1.0, t);                  // 0 in the shade of its neighbours, 1 in the light
  vec3 albedo = mix(vec3(0.030, 0.060, 0.012), tint_facing.rgb, 0.12 + 0.88 * t);
  vec3 through = vec3(1.20, 1.05, 0.40) * albedo * (0.30 + 1.5 * against * against);
  vec3 sum = albedo * kSkyLight * (0.25 + 0.75 * deep) * (0.40 + 1.0 * max(normal.y, 0.0));
  float open = mix(0.16, 1.0, sunlight_near(place));
  sum += kSunLight * open * (albedo * max(facing, 0.0) * 0.75 + through * max(-facing, 0.12) * 0.8) * (0.10 + 0.90 * deep);
  float sheen_side = dot(along, normalize(to_sun.xyz + to_eye));
  float sheen = sqrt(max(1.0 - sheen_side * sheen_side, 0.0));
  sheen *= sheen;
  sheen *= sheen;
  sheen *= sheen;
  sheen *= sheen;
  sum += kSunLight * open * vec3(0.15, 0.155, 0.12) * sheen * deep * (0.4 + 1.1 * (1.0 - along.y));

  // Between upright blades the dark ground shows; of blades that the wind has bent one sees the lit sides. Measured by
  // this blade's own bend (the sine of its chord), since its neighbours bend alike.
  vec3 chord = joint(0, strand, links - 1) - root_width.xyz;
  sum *= exp2(4.0 * (length(chord.xz) / length(chord) - 0.60));

  shade = seen(sum, place);
}
