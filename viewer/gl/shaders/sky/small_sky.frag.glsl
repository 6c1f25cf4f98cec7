#include "sky.part.glsl"
// The sky without sun, moon and stars (SmallSky).
out vec4 color;

void main() { color = sky_in(normalize(ray)); }
