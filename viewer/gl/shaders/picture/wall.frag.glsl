// A window's part of the picture, as its monitor is to show it (viewer/wall/window_map.hpp has the same formulas).
uniform sampler2D picture;
uniform vec2 monitor_px;
uniform mat3 to_crop;  // from a place on the monitor; both 0 to 1, y down
uniform vec4 crop;     // x, y, width, height, of the picture
uniform vec4 blend;    // at the left, right, upper and lower side of the crop, as parts of it
uniform float gamma;
uniform bool is_marked;  // with its border and its strips, for the test card

out vec4 color;

float ramp(float from_side, float width) {
  float into = width > 0.0 ? clamp(from_side / width, 0.0, 1.0) : 1.0;
  return into < 0.5 ? 2.0 * into * into : 1.0 - 2.0 * (1.0 - into) * (1.0 - into);
}

void main() {
  vec2 place = gl_FragCoord.xy / monitor_px;
  vec3 at = to_crop * vec3(place.x, 1.0 - place.y, 1.0);
  vec2 in_crop = at.xy / at.z;
  vec2 from_sides = min(in_crop, 1.0 - in_crop);
  vec2 pixel = max(fwidth(in_crop), vec2(1e-7));
  // A pixel whose middle is half a pixel inside is all of it inside.
  vec2 inside = clamp(from_sides / pixel + 0.5, 0.0, 1.0);
  if (at.z <= 0.0 || inside.x * inside.y <= 0.0) {
    color = vec4(0.0, 0.0, 0.0, 1.0);
    return;
  }
  vec2 in_picture = crop.xy + in_crop * crop.zw;
  vec3 value = texture(picture, vec2(in_picture.x, 1.0 - in_picture.y)).rgb;
  float light = ramp(in_crop.x, blend.x) * ramp(1.0 - in_crop.x, blend.y) * ramp(in_crop.y, blend.z) *
                ramp(1.0 - in_crop.y, blend.w);
  value *= pow(light, 1.0 / gamma) * inside.x * inside.y;
  if (is_marked) {
    vec4 from_strips = abs(vec4(in_crop.x, 1.0 - in_crop.x, in_crop.y, 1.0 - in_crop.y) - blend) / pixel.xxyy;
    if (any(lessThan(from_strips + 1e3 * vec4(equal(blend, vec4(0.0))), vec4(1.0)))) value = vec3(1.0, 0.8, 0.0);
    if (any(lessThan(from_sides / pixel, vec2(2.0)))) value = vec3(1.0, 0.2, 0.1);
  }
  color = vec4(value, 1.0);
}
