// The undercoat: a dark disc at each root, facing the eye, so that no gap shows between the hairs.
uniform vec3 body_middle_m;
uniform vec3 body_radius_m;
uniform float disc_m;

layout(location = 0) in vec4 root_width;
layout(location = 1) in vec4 tint_facing;

out vec3 shade;

void main() {
  float angle = float(gl_VertexID) * 1.04719755;
  vec2 corner = vec2(cos(angle), sin(angle)) * disc_m;
  vec3 place = root_width.xyz + right.xyz * corner.x + up.xyz * corner.y;
  vec3 out_of_body = normalize((root_width.xyz - body_middle_m) / (body_radius_m * body_radius_m));
  place -= out_of_body * (0.4 * disc_m);
  gl_Position = to_clip * vec4(place, 1.0);
  float lit = smoothstep(-0.35, 0.75, dot(out_of_body, to_sun.xyz));
  shade = seen(tint_facing.rgb * 0.30 * (soft_light(out_of_body) * 0.6 + sun_light.rgb * 0.35 * lit + 0.5 * fire_light(place, out_of_body)), place);
}
