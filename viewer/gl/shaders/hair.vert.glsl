// A hair: a thin ribbon along a strand's joints that faces the eye, with its light (after Kajiya and Kay 1989, "Rendering fur with
// three dimensional textures").
uniform int rings;
uniform vec3 body_middle_m;
uniform vec3 body_radius_m;

layout(location = 0) in vec4 root_width;   // metres
layout(location = 1) in vec4 tint_facing;  // the tip's colour
layout(location = 2) in uint strand;

out vec3 shade;

void main() {
  int ring = gl_VertexID >> 1;
  float side = float(gl_VertexID & 1) * 2.0 - 1.0;
  int link = ring * links / rings;
  int link_below = (ring - 1) * links / rings;
  vec3 place = ring > 0 ? joint(0, strand, link - 1) : root_width.xyz;
  vec3 along =
      ring > 1 ? place - joint(0, strand, link_below - 1) : (ring > 0 ? place : joint(0, strand, links / rings - 1)) - root_width.xyz;
  along = normalize(along);
  float t = float(ring) / float(rings);

  vec3 to_eye = eye_m.xyz - place;
  float distance_m = length(to_eye);
  to_eye /= distance_m;
  float half_width = 0.5 * root_width.w * sqrt(1.0 - t) * (1.0 - 0.3 * t);
  half_width = max(half_width, 0.40 * eye_m.w * distance_m * min(1.0, 3.0 * (1.0 - t)));
  place += normalize(cross(along, to_eye)) * (side * half_width);
  gl_Position = to_clip * vec4(place, 1.0);

  // The body's normal shades the hair; it is dark deep in the coat and pale at the tip.
  vec3 out_of_body = normalize((root_width.xyz - body_middle_m) / (body_radius_m * body_radius_m));
  float lit = smoothstep(-0.35, 0.75, dot(out_of_body, to_sun.xyz));
  vec3 albedo = mix(tint_facing.rgb * 0.30, tint_facing.rgb, smoothstep(0.0, 0.8, t));
  albedo = mix(albedo, vec3(0.62, 0.50, 0.36), 0.45 * smoothstep(0.62, 1.0, t));
  float along_sun = dot(along, to_sun.xyz);
  float across_sun = sqrt(max(1.0 - along_sun * along_sun, 0.0));
  float along_eye = dot(along, to_eye);
  float shine = max(across_sun * sqrt(max(1.0 - along_eye * along_eye, 0.0)) - along_sun * along_eye, 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  float deep = 0.25 + 0.75 * t;
  vec3 sum = albedo * soft_light(out_of_body) * 1.5 * deep;
  sum += albedo * fire_light(place, out_of_body) * deep;
  sum += albedo * sun_light.rgb * 0.75 * across_sun * lit * deep;
  sum += sun_light.rgb * vec3(0.10, 0.085, 0.065) * shine * shine * lit * t;
  float rim = 1.0 - abs(dot(out_of_body, to_eye));
  float against = max(-dot(to_eye, to_sun.xyz), 0.0);
  sum += albedo * sun_light.rgb * 0.9 * rim * rim * against * against * t;
  shade = seen(sum, place);
}
