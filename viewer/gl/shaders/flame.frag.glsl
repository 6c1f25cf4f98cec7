// A flame emits light, by the color ramp, and hides little of what is behind it.
uniform sampler2D ramp;  // 256 colours, sRGB, straight alpha
uniform int is_closed;

in vec3 place_m;
in vec3 normal;
in float heat;
in float along;   // the flame: 0 at its foot, 1 at its top
in float inward;  // 0: the outermost shell, 1: the innermost
out vec4 color;

void main() {
  // A body of flame is thinner and redder toward its outline, and where only its outermost shell is in view; the inner
  // shells are white.
  float facing = abs(dot(normalize(normal), normalize(place_m - eye_m.xyz)));
  float thick = is_closed == 1 ? smoothstep(0.0, 0.8, facing) : 1.0;
  float seen_heat = clamp(heat, 0.0, 1.0) * mix(0.55, 1.0, thick) * mix(0.62, 1.0, inward);
  vec4 hot = texture(ramp, vec2((seen_heat * 255.0 + 0.5) / 256.0, 0.5));
  float share = hot.a * (is_closed == 1 ? 0.45 : 1.0) * thick * smoothstep(0.0, 0.12, along);
  color = vec4(hot.rgb * share, 0.60 * share);
}
