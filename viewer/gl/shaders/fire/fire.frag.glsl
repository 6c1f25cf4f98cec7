// The body of a flame: the light of all its gas along the ray, which goes straight in the world and bends in the body, row
// by row. The gas (FlameGas) has where it burns; noise that rises with it dissolves its edges, the more the higher.
uniform sampler3D gas_tile;    // heat, soot
uniform sampler2D layer_rows;  // two texels a layer: FlameVolume::Layer
uniform sampler2D noise_tile;
uniform sampler2D ramp;        // 256 colours, sRGB, straight alpha
uniform int steps;
uniform float reach;           // the part of the way to the top at which the layers end
uniform vec2 size_m;           // its radius and its height at rest
uniform float risen;           // how far the gas has, in heights
uniform vec2 floor_m;          // no gas burns below the first height, nothing keeps it from burning above the second
uniform float brightness;
uniform float by_day;          // 0 by night to 1: bright ground behind the fire shines through it less

in vec3 place_m;
in vec3 inside;
out vec4 color;

void main() {
  vec3 ray = normalize(place_m - eye_m.xyz);
  vec2 at_m = inside.xy;
  float v = inside.z;
  float y_m = place_m.y;
  vec2 layers = vec2(textureSize(layer_rows, 0));
  float gas_layers = float(textureSize(gas_tile, 0).z);
  float chance = 0.3 + 0.4 * pixel_chance(gl_FragCoord.xy);
  vec3 sum = vec3(0.0);
  float soot = 0.0;
  float clear = 1.0;  // the part of the light that the flame in front lets through
  bool was_inside = false;
  for (int i = 0; i < steps; ++i) {
    float part = clamp(v / reach, 0.0, 1.0);
    float layer = (part * (layers.y - 1.0) + 0.5) / layers.y;
    vec4 row = textureLod(layer_rows, vec2(0.25, layer), 0.0);    // to the top; half its side
    vec4 slope = textureLod(layer_rows, vec2(0.75, layer), 0.0);  // east, south; how they grow
    // How high the body is above one point of the ground, were all of it as this layer is.
    float height_m = max(row.y + dot(slope.xy, row.xz) - dot(slope.zw, at_m), 0.2 * size_m.y);
    float up = (ray.y + dot(slope.xy, ray.xz)) / height_m;
    vec2 aside = ray.xz - row.xz * up;
    // As long as a part of the body is thick, across it or along it.
    float step_m = 2.0 / (float(steps) * max(length(aside) / row.w, 1.3 * abs(up)));
    if (i == 0) {
      at_m += aside * (step_m * chance);
      v += up * (step_m * chance);
      y_m += ray.y * (step_m * chance);
    }

    vec2 q = at_m / row.w;
    // The ray begins on a mesh around the body, which may be a little outside of it.
    bool is_inside = dot(q, q) < 1.2 && v > -0.01 && v < reach + 0.01;
    if (was_inside && !is_inside) break;
    was_inside = is_inside;
    vec2 gas = is_inside ? textureLod(gas_tile, vec3(0.5 + 0.5 * q, (part * (gas_layers - 1.0) + 0.5) / gas_layers), 0.0).rg
                         : vec2(0.0);
    if (gas.r > 0.05) {
      // Two noises at right angles to each other, drawn out along the flame.
      vec2 across = mat2(0.8, 0.6, -0.6, 0.8) * at_m / size_m.x;
      float one = textureLod(noise_tile, vec2(0.17 * across.x + 0.03 * across.y, 0.0077 * (v - risen)), 0.5).r;
      float two = textureLod(noise_tile, vec2(0.19 * across.y - 0.03 * across.x, 0.0098 * (v - risen) + 0.01 * one), 0.5).r;
      float torn = one + two - 1.0;
      float high = min(v * 1.6, 1.0);
      float level = 1.5 * (gas.r - 0.22) + torn * (0.60 + 0.75 * high);
      level -= 2.5 * smoothstep(floor_m.y, floor_m.x, y_m);
      // It burns in sheets around what is hottest.
      float thick = smoothstep(0.0, 0.45, level) * (1.0 - 0.2 * smoothstep(0.40, 1.0, level));
      vec4 hot = textureLod(ramp, vec2((clamp(0.29 + 0.42 * level - 0.10 * min(v, 1.0), 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5), 0.0);
      // What flies off is thinner and darker: it passes a place more often than three times in a second.
      thick *= mix(1.0, mix(0.22, 0.36, by_day), smoothstep(0.12, 0.60, v));
      // Tongues: bright where both noises are high.
      float bright = 0.15 + 14.0 * one * one * two * two;
      // From near, the foot is made of flamelets that rise as slowly as its gas, with gaps between. Its gas hides what is
      // behind, so that they do not blur into one another.
      float foot = smoothstep(0.50, 0.15, v);
      if (foot > 0.0) {
        float three = textureLod(noise_tile, vec2(0.45 * across.x + 0.30 * across.y + 0.10 * one,
                                                  0.05 * v - 0.0225 * risen + 0.12 * two), 0.0).r;
        float flamelet = smoothstep(0.38, 0.64, three + 0.35 * (gas.r - 0.6));
        bright *= mix(1.0, 0.15 + 1.9 * flamelet, foot);
      }
      sum += hot.rgb * hot.rgb * (clear * thick * step_m * bright);
      clear /= 1.0 + foot * 3.5 * thick * step_m / size_m.x;
      // The blue of the root, where air still reaches the gas.
      sum += vec3(0.004, 0.012, 0.06) * (clear * step_m * thick * smoothstep(0.25, 0.08, v) * smoothstep(0.5, 0.0, level));
    }
    soot += gas.g * step_m;
    at_m += aside * step_m;
    v += up * step_m;
    y_m += ray.y * step_m;
  }
  // Hot gas is yellow, and the tips are dark orange, although the eye sees other dim light without color. Never a saturated
  // red (R / (R + G + B) of 0.8), whose flicker is the most harmful: orange at most.
  vec3 light = finish(sum * (brightness / size_m.x));
  float glow = max(light.r, max(light.g, light.b));
  vec3 value = glow * vec3(1.0, mix(0.555, 0.84, smoothstep(0.50, 1.0, glow)), mix(0.06, 0.30, smoothstep(0.75, 1.0, glow)));
  // Glowing soot hides what is behind it, so that the fire keeps its color before a bright sky. Where it no longer glows it is
  // smoke, lit by sky and sun.
  float hides = 1.0 - pow(1.0 - 0.92 * glow, 1.0 + 0.7 * by_day);
  float smoke = 0.5 * (1.0 - exp(-1.1 * soot / size_m.x)) * (1.0 - glow);
  value += finish(0.16 * (sky_light.rgb + 0.3 * sun_light.rgb)) * smoke;
  color = vec4(value, max(hides, smoke));
}
