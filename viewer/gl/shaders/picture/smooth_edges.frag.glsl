// A finished picture with its edges smoothed, after T. Lottes 2009, "FXAA": where brightness leaps, the pixel is mixed with
// its neighbours along the edge; what is smaller than a pixel, with all of them. A sky that was left out stays transparent.
uniform sampler2D picture;
out vec4 color;

const float kLeast = 0.04;      // a smaller leap of brightness is left alone
const float kLeastPart = 0.10;  // of the brightness
const float kLongest_px = 6.0;  // along an edge
const float kFine = 0.85;       // of what is smaller than a pixel, that is spread

float brightness(vec4 value) { return dot(value.rgb, vec3(0.299, 0.587, 0.114)); }

void main() {
  vec2 pixel = 1.0 / vec2(textureSize(picture, 0));
  vec2 at = gl_FragCoord.xy * pixel;
  vec4 here = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
  // Each is the mean of four pixels; together they are the picture, softer.
  vec4 low_left = textureLod(picture, at + vec2(-0.5, -0.5) * pixel, 0.0);
  vec4 low_right = textureLod(picture, at + vec2(0.5, -0.5) * pixel, 0.0);
  vec4 high_left = textureLod(picture, at + vec2(-0.5, 0.5) * pixel, 0.0);
  vec4 high_right = textureLod(picture, at + vec2(0.5, 0.5) * pixel, 0.0);
  vec4 corners = vec4(brightness(low_left), brightness(low_right), brightness(high_left), brightness(high_right));
  float own = brightness(here);
  float lowest = min(own, min(min(corners.x, corners.y), min(corners.z, corners.w)));
  float highest = max(own, max(max(corners.x, corners.y), max(corners.z, corners.w)));
  float leap = highest - lowest;
  if (leap < max(kLeast, kLeastPart * highest)) {
    color = here;
    return;
  }

  // Along the edge: across the way in which brightness grows.
  vec2 along = vec2((corners.x + corners.y) - (corners.z + corners.w), (corners.y + corners.w) - (corners.x + corners.z));
  along *= 1.0 / max(min(abs(along.x), abs(along.y)), 0.03 * dot(corners, vec4(1.0)) + 0.004);
  along = clamp(along, -kLongest_px, kLongest_px) * pixel;
  vec4 edge = 0.5 * (textureLod(picture, at - along * (1.0 / 6.0), 0.0) + textureLod(picture, at + along * (1.0 / 6.0), 0.0));

  vec4 soft = 0.25 * (low_left + low_right + high_left + high_right);
  float fine = smoothstep(0.0, 0.5, abs(brightness(soft) - own) / leap);
  color = mix(edge, soft, kFine * fine);
}
