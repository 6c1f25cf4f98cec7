// A picture to set up a wall by: squares, circles, diagonals, greys and colors. Circles that are round and lines that are
// straight and meet say that the corners are right; greys that are even say that the blend is.
uniform vec2 picture_px;

out vec4 color;

const float kSquares = 9.0;  // in the picture's height
const vec3 kInk = vec3(0.92);

float line(float distance_px, float width_px) { return clamp(0.5 * width_px + 0.5 - abs(distance_px), 0.0, 1.0); }
float ring(vec2 at_px, vec2 middle_px, float radius_px) { return line(distance(at_px, middle_px) - radius_px, 2.0); }

void main() {
  vec2 middle = 0.5 * picture_px;
  vec2 at = gl_FragCoord.xy;
  vec2 from_middle = at - middle;
  float square = picture_px.y / kSquares;

  vec3 value = vec3(0.12);
  vec2 squares = from_middle / square + 0.5;
  if (mod(floor(squares.x) + floor(squares.y), 2.0) == 0.0) value = vec3(0.18);
  vec2 from_line = min(fract(squares), 1.0 - fract(squares)) * square;
  float ink = 0.7 * max(line(from_line.x, 1.0), line(from_line.y, 1.0));

  // Greys above the middle, colors below it.
  float part = at.x / picture_px.x;
  if (abs(from_middle.y - square) < 0.5 * square) value = vec3(floor(part * 16.0) / 15.0);
  if (abs(from_middle.y + square) < 0.5 * square) {
    float bar = floor(part * 8.0);
    value = 0.8 * vec3(mod(bar, 2.0), mod(floor(bar / 2.0), 2.0), floor(bar / 4.0));
  }

  ink = max(ink, line((from_middle.x * picture_px.y - from_middle.y * picture_px.x) / length(picture_px), 1.5));
  ink = max(ink, line((from_middle.x * picture_px.y + from_middle.y * picture_px.x) / length(picture_px), 1.5));
  ink = max(ink, max(line(from_middle.x, 2.0), line(from_middle.y, 2.0)));
  ink = max(ink, ring(at, middle, 4.0 * square));
  vec2 corner = mix(vec2(square), picture_px - square, step(middle, at));
  ink = max(ink, ring(at, corner, 0.9 * square));
  vec2 from_sides = min(at, picture_px - at);
  ink = max(ink, step(min(from_sides.x, from_sides.y), 2.0));
  color = vec4(mix(value, kInk, ink), 1.0);
}
