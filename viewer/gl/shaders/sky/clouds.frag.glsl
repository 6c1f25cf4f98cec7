// A map of the clouds above the ground, by bearing and height: red, how much they cover; green, the sun's light on what is
// seen of them; blue, the sky's; alpha, thin ice clouds far above. By steps along each ray through a layer of water clouds
// (after A. Schneider 2015, "The real-time volumetric cloudscapes of Horizon: Zero Dawn"). Unit: the height of their bases.
uniform sampler2D noise_tile;
uniform vec3 cover;     // the clouds' drift; the noise above which there is a cloud
uniform vec3 sun_then;  // toward the sun
out vec4 color;

const vec2 kTexels = vec2(2048.0, 256.0);  // cloud_map.cpp
const int kSteps = 28;
const float kThickness = 0.55;
const float kEarth = 4200.0;      // its radius
const float kDensity = 26.0;      // light falls to 1 / e in a part of this
const float kTexel = 0.0035;      // of the map, radians

// How much cloud stands above a place: below 0 none.
float heap(vec2 at, float blur) {
  float broad = textureLod(noise_tile, at.yx * 0.030 + 0.13, blur - 3.1).r;
  float heaps = textureLod(noise_tile, at * 0.095, blur - 1.4).r;
  return 0.42 * broad + 0.58 * heaps - cover.z;
}

// The density at a height above the bases: heaps, narrower the higher up, with lumps on them.
float density(vec2 at, float up, float blur) {
  float body = heap(at, blur) - 0.42 * pow(up / kThickness, 1.4);
  float dense = 0.0;
  // Once or not at all: a branch in which no pixel goes on is computed by llvmpipe nevertheless, a loop is not.
  for (float heaped = body; heaped >= -0.12; heaped = -1.0) {
    float lumps = textureLod(noise_tile, at * 0.42 + vec2(0.31, -0.23) * up, blur + 0.7).r;
    float fine = textureLod(noise_tile, at.yx * 1.30 + vec2(-0.9, 0.7) * up, blur + 2.4).r;
    float full = body + 0.20 * (lumps - 0.62) + 0.07 * (fine - 0.5);
    dense = clamp(9.0 * full, 0.0, 1.0) * smoothstep(0.0, 0.035, up);
  }
  return dense;
}

// What is left of the sun's light at a place in a cloud; some of it comes by many ways.
float sun_through(vec2 at, float up, float blur) {
  float depth = 0.0;
  float before = 0.0;
  for (int i = 0; i < 3; ++i) {
    float far = 0.045 * exp2(1.3 * float(i));
    vec3 to = sun_then * far;
    float there = up + to.y;
    if (there < 0.0 || there > kThickness) break;
    depth += kDensity * (far - before) * density(at + to.xz, there, blur + 1.0);
    before = far;
  }
  return max(exp(-depth), 0.62 * exp(-0.22 * depth));
}

void main() {
  float bearing = 6.2831853 * gl_FragCoord.x / kTexels.x;
  float height = gl_FragCoord.y / kTexels.y;
  height *= height;  // the sine: most rows are near the horizon
  float level = sqrt(1.0 - height * height);
  vec2 way = vec2(sin(bearing), -cos(bearing)) * level;

  // The layer begins and ends where the ray comes to these heights above the round earth.
  float first = kEarth * (sqrt(height * height + 2.0 / kEarth) - height);
  float last = kEarth * (sqrt(height * height + 2.0 * (1.0 + kThickness) / kEarth) - height);
  float step_long = (last - first) / float(kSteps);
  float left = 1.0;
  float sun = 0.0;
  float sky = 0.0;
  float blur = log2(256.0 * 0.3 * first * kTexel);
  for (int i = 0; i < kSteps; ++i) {
    float up = kThickness * (float(i) + 0.5) / float(kSteps);
    vec2 at = way * (first + step_long * (float(i) + 0.5)) - cover.xy;
    float here = density(at, up, blur);
    for (float cloud = here; cloud > 0.0; cloud = 0.0) {
      float part = left * (1.0 - exp(-kDensity * min(step_long, 0.25) * here));
      sun += part * sun_through(at, up, blur);
      // Thin parts let light down to the base; of an overcast sky the parts that are thinner than the others.
      float deep = max(heap(at, blur) + min(cover.z - 0.34, 0.0), 0.0);
      sky += part * (mix(0.75, 0.30, smoothstep(0.45, 0.15, cover.z)) * smoothstep(0.0, 0.65 * kThickness, up) + 1.3 * exp(-mix(3.6, 4.8, smoothstep(0.45, 0.15, cover.z)) * deep));
      left -= part;
    }
    if (left < 0.02) break;
  }
  float covered = min((1.0 - left) * 1.02, 1.0);
  vec2 light = min(vec2(sun, sky) / max(1.0 - left, 1e-3), 1.0);

  // Ice: combed out by the wind, in fields.
  vec2 ice_at = way * (5.0 / (height + 0.06)) - cover.xy;
  vec2 bent = vec2(texture(noise_tile, ice_at * 0.010).r, texture(noise_tile, ice_at.yx * 0.010 + 0.4).r);
  float combed = texture(noise_tile, ice_at * vec2(0.015, 0.065) + 0.45 * bent).r;
  float fields = texture(noise_tile, ice_at * 0.005 + 0.6).r;
  float ice = smoothstep(0.45, 0.95, combed) * smoothstep(0.35, 0.65, fields) * smoothstep(0.90, 0.55, cover.z) * smoothstep(0.0, 0.12, height);
  color = vec4(covered, light, ice);
}
