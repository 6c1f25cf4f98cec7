// A flat flame emits light by the color ramp.
uniform sampler2D ramp;  // 256 colours, sRGB, straight alpha
uniform float brightness;

in float heat;
in float along;  // 0 at its foot, 1 at its top
out vec4 color;

void main() {
  vec4 hot = texture(ramp, vec2((clamp(heat, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5));
  float share = hot.a * hot.a * smoothstep(0.0, 0.12, along);
  color = vec4(finish(hot.rgb * hot.rgb * (brightness * share)), 0.0);
}
