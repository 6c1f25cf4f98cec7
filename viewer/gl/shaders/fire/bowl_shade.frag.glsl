// Multiplies what is behind it: less, the more of the light there is the fire's.
uniform vec4 shade_m;
in vec2 beside_m;
in vec3 place_m;
out vec4 color;

void main() {
  const vec3 kUp = vec3(0.0, 1.0, 0.0);
  const vec3 kGrey = vec3(0.2126, 0.7152, 0.0722);
  float fire = dot(fire_light(place_m, kUp), kGrey);
  float other = dot(soft_light(kUp) + sun_light.rgb * max(to_sun.y, 0.0), kGrey);
  float shade = 0.75 * smoothstep(shade_m.w, shade_m.z, length(beside_m)) * fire / max(fire + other, 1e-6);
  // Of the screen's values, which are roughly square roots of light.
  color = vec4(vec3(sqrt(1.0 - shade * (1.0 - haze(distance(eye_m.xyz, place_m))))), 1.0);
}
