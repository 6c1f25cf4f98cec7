// A small picture of the sky, enlarged (SmallSky).
uniform sampler2D small_sky;
uniform vec2 pixel;  // of the picture, as a part of its sides
out vec4 color;

void main() { color = vec4(dithered(textureLod(small_sky, gl_FragCoord.xy * pixel, 0.0).rgb, gl_FragCoord.xy), 1.0); }
