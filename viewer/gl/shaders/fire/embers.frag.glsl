// Lumps of charcoal that glow in the gaps between them, brighter and darker by turns as the air reaches them.
uniform sampler2D noise_tile;
uniform float brightness;
uniform float breath;  // turns of the slow change, 0 to 1

in vec2 at;
out vec4 color;

void main() {
  float lumps = textureLod(noise_tile, 0.42 * at + 0.3, 1.0).r;
  float air = textureLod(noise_tile, 0.13 * at + 0.6, 3.0).r;
  float breathes = 0.75 + 0.25 * sin(6.2831853 * (breath + 2.0 * air));
  float glowing = smoothstep(0.62, 0.30, lumps) * smoothstep(1.0, 0.55, length(at)) * breathes;
  color = vec4(finish(vec3(2.6, 0.52, 0.07) * (brightness * glowing)), 0.0);
}
