// Two pictures mixed as lights, not as the screen's values: what is bright in either stays bright.
uniform sampler2D picture_before;
uniform sampler2D picture_now;
uniform float share;

out vec4 color;

// The light of the screen's values (IEC 61966-2-1, sRGB), exactly: each picture is to begin and end as it is.
vec3 light_of(vec3 value) {
  return mix(pow((value + 0.055) / 1.055, vec3(2.4)), value / 12.92, lessThanEqual(value, vec3(0.04045)));
}
vec3 value_of(vec3 light) {
  return mix(1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 before = texelFetch(picture_before, pixel, 0);
  vec4 now = texelFetch(picture_now, pixel, 0);
  color = vec4(value_of(mix(light_of(before.rgb), light_of(now.rgb), share)), mix(before.a, now.a, share));
}
