// The turf ends raggedly.
uniform sampler2D noise_tile;
in vec2 at_m;
in float edge;
out vec4 color;

void main() {
  float ragged = texture(noise_tile, at_m * 0.45).r + 0.5 * texture(noise_tile, at_m * 2.3).r - 0.75;
  float broad = texture(noise_tile, at_m * 0.085 + 0.6).r - 0.5;  // here the turf goes down to the water, there it does not
  if (edge > 0.60 + 0.55 * ragged + 1.3 * broad) discard;
  color = vec4(1.0);
}
