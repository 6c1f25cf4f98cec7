// A flame's own light, through the ramp; it hides little of what is behind it.
uniform sampler2D ramp;  // 256 colours, as a screen shows them, straight alpha
uniform int is_closed;
uniform vec2 range_m;    // height of the foot above the ground, and of the whole above it

in vec3 place_m;
in vec3 normal;
in float heat;
out vec4 color;

void main() {
  vec4 hot = texture(ramp, vec2((clamp(heat, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5));

  // A body of flame is thin where one looks along its skin.
  float facing = abs(dot(normalize(normal), normalize(place_m - eye_m.xyz)));
  float thick = is_closed == 1 ? 0.75 * smoothstep(0.05, 0.75, facing) : 1.0;
  float share = hot.a * thick * smoothstep(0.0, 0.12, (place_m.y - range_m.x) / range_m.y);
  color = vec4(hot.rgb * share, 0.60 * share);
}
