// The evening sky: air, a veil of high cloud, the sun.
uniform sampler2D noise_tile;
in vec3 ray;
in float ray_length;
in vec3 clear;
in vec3 clouded;
out vec4 color;

void main() {
  // Streaks of cloud on a level plane high above, fading at the horizon.
  float height = max(ray.y / ray_length, 0.0);
  vec2 ceiling = ray.xz / (ray_length * (height + 0.12));
  float broad = texture(noise_tile, ceiling * vec2(0.050, 0.085)).r;
  float fine = texture(noise_tile, ceiling * vec2(0.21, 0.33) + 0.37).r;
  float cloud = smoothstep(0.46, 0.86, broad * 0.70 + fine * 0.30) * smoothstep(0.02, 0.20, height);

  float sun = smoothstep(0.99962, 0.99985, dot(normalize(ray), to_sun.xyz));
  color = vec4(mix(mix(clear, clouded, cloud), vec3(1.0, 0.99, 0.93), sun), 1.0);
}
