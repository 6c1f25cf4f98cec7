// A hair: a thin ribbon along a strand's joints that faces the eye. Around each strand more hairs stand that bend as it does:
// soft underhair, and guard hairs that are longer, stiffer and banded (agouti), as of wild animals.
//
// Its light after J. Kajiya and T. Kay 1989, "Rendering fur with three dimensional textures", with the two highlights of S.
// Marschner and others 2003, "Light scattering from human hair fibers": that of the surface, moved to the root, and that
// from within, coloured and moved to the tip.
uniform int first_corner;
uniform int rings;
uniform int copies;  // hairs a strand
uniform vec3 body_middle_m;
uniform mat3 body_shape;
uniform float spacing_m;  // of the strands

uniform Numbers blades;  // three texels each: root and width, metres; the coat's colour here; number, length in metres, how much the coat parts

out vec3 shade;

float chance_of(float seed, uint strand) {
  return fract(sin(seed * 12.9898 + float(strand % 8191u) * 0.7548777) * 43758.5453);
}

float lobe(vec3 along, vec3 half_way, float sharpness) {
  float across = dot(along, half_way);
  return pow(max(1.0 - across * across, 0.0), sharpness);
}

void main() {
  int number = first_corner + gl_VertexID;
  int ribbon = number >> 8;
  int blade = ribbon / copies;
  int copy = ribbon - blade * copies;
  vec4 root_width = fetch(blades, 3 * blade);
  vec3 tint = fetch(blades, 3 * blade + 1).rgb;
  vec3 traits = fetch(blades, 3 * blade + 2).xyz;
  uint strand = uint(traits.x);
  float whole_m = traits.y;
  int ring = (number & 255) >> 1;
  float side = float(number & 1) * 2.0 - 1.0;
  float t = float(ring) / float(rings);
  float seed = float(copy) + 1.0;
  float which = chance_of(seed, strand);
  float other = chance_of(seed + 31.7, strand);
  bool is_guard = copy == 0 || which > 0.72;

  // Farther away one hair stands for more and more of them.
  // Where the wind parts the coat, one sees down to its wool; where it presses hairs together, their dark tips alone.
  // From afar its hairs hide that again, or the coat would look spotted.
  float height_px = whole_m / (eye_m.w * distance(eye_m.xyz, root_width.xyz));
  float near = smoothstep(20.0, 50.0, height_px);
  float open_seen = mix(0.15, 0.70, smoothstep(10.0, 90.0, height_px));
  float parted = open_seen * smoothstep(0.0, 0.28, traits.z);
  float pressed = open_seen * smoothstep(0.0, 0.28, -traits.z);
  float shown = copies > 1 ? 1.0 + float(copies - 1) * near : 1.0;
  float is_up = clamp(shown - float(copy), 0.0, 1.0);
  if (is_up <= 0.0) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    shade = vec3(0.0);
    return;
  }

  // Where it grows: beside the strand, on the skin.
  vec3 root = root_width.xyz;
  vec3 out_of_body = normalize(body_shape * (root - body_middle_m));
  vec3 own_root = root;
  if (copy > 0) {
    vec3 east = normalize(cross(out_of_body, vec3(0.31, 0.17, 0.93)));
    float turn = 6.2831853 * other;
    own_root += (east * cos(turn) + cross(out_of_body, east) * sin(turn)) * (1.15 * spacing_m * sqrt(fract(other * 57.0)));
    vec3 off = own_root - body_middle_m;
    own_root = body_middle_m + off * inversesqrt(dot(off, body_shape * off));
  }
  float longer = is_guard ? 0.85 + 0.35 * which : 0.50 + 0.38 * fract(which * 17.0);

  int link = ring * links / rings;
  int link_below = (ring - 1) * links / rings;
  vec3 on_strand = ring > 0 ? joint(0, strand, link - 1) : root;
  vec3 along =
      ring > 1 ? on_strand - joint(0, strand, link_below - 1) : (ring > 0 ? on_strand : joint(0, strand, links / rings - 1)) - root;
  along = normalize(along);
  // Underhair stands up more; hairs of a lock meet at their tips, and a few stray.
  vec3 grown = on_strand - root;
  float length_m = length(grown);
  float stray = (fract(which * 91.0) - 0.5) * mix(2.0, 1.0, near) * (is_guard ? 0.26 : 0.12);
  vec3 aside = cross(out_of_body, along);
  vec3 place = mix(own_root, root, 0.30 * t) + grown * longer + (is_guard ? 0.12 * (1.0 - near) : 0.12) * length_m * t * out_of_body + aside * (stray * length_m);

  place -= out_of_body * (0.40 * parted * max(dot(place - own_root, out_of_body), 0.0));

  vec3 to_eye = eye_m.xyz - place;
  float distance_m = length(to_eye);
  to_eye /= distance_m;

  // A hair that points at the eye would be a dot, with skin around it: it hangs down, as all of them there, and looks
  // thicker.
  float end_on = smoothstep(0.60, 0.97, abs(dot(along, to_eye)));
  vec3 curves_to = normalize(cross(cross(along, vec3(0.0, -1.0, 0.0)), along) + 0.5 * (other - 0.5) * aside + vec3(0.0, -1e-4, 0.0));
  place += curves_to * (0.42 * end_on * t * t * length_m);
  along = normalize(along + curves_to * (0.84 * end_on * t));

  float half_width = 0.5 * root_width.w * is_up * pow(shown, -0.36) * (is_guard ? 1.30 : 1.15) * sqrt(1.0 - t) * (1.0 - 0.2 * t) * (1.0 + 0.6 * end_on);
  half_width = max(half_width, is_up * mix(0.62, 0.45, near) * eye_m.w * distance_m * min(1.0, 3.0 * (1.0 - t)));
  place += normalize(cross(along, to_eye)) * (side * half_width);
  gl_Position = to_clip * vec4(place, 1.0);

  // Pale at the root; a guard hair has a light band below its dark tip.
  vec3 wool = vec3(0.52, 0.38, 0.245) * (0.85 + 0.3 * other);
  vec3 coat = tint * (0.80 + 0.4 * fract(other * 13.0));
  vec3 albedo = mix(wool, coat, smoothstep(0.12 + 0.45 * parted, 0.50 + 0.50 * parted, t));
  if (is_guard) {
    float band = 0.80 + 0.10 * (other - 0.5);
    // Far away the bands run together.
    albedo = mix(albedo, vec3(0.66, 0.49, 0.29), mix(0.22, 0.85, near) * smoothstep(band - 0.20, band - 0.05, t));
    albedo = mix(albedo, vec3(0.050, 0.032, 0.022), mix(0.25, 0.90, near) * smoothstep(band + 0.01, band + 0.10, t) * step(0.35, fract(which * 7.0)) * (1.0 - 0.8 * parted));
  } else {
    albedo = mix(albedo, mix(coat, vec3(0.52, 0.36, 0.20), 0.45), smoothstep(0.55, 1.0, t));
  }

  albedo *= 1.0 + 0.22 * parted - 0.35 * pressed;

  // How deep in the coat it is, and how far the light comes to it there: less from low above the skin.
  float sun_up = dot(out_of_body, to_sun.xyz);
  // Where the coat is open the light comes farther down.
  float deep = (1.0 - t * mix(0.8, 1.0, longer)) * (is_guard ? 0.85 : 1.0) * (1.0 - 0.45 * parted);
  float lit = smoothstep(-0.30, 0.35, sun_up) * exp(-1.9 * deep / (0.35 + max(sun_up, 0.0)));
  float sun_through = below_clouds(own_root);  // clouds
  lit *= sun_through * mix(0.2, 1.0, sunlight_near(own_root + 0.15 * out_of_body));
  float open_sky = 0.16 + 0.80 * (1.0 - deep) * (1.0 - deep) + 0.27 * (1.0 - deep);

  float along_sun = dot(along, to_sun.xyz);
  float across_sun = sqrt(max(1.0 - along_sun * along_sun, 0.0));
  vec3 half_way = normalize(to_sun.xyz + to_eye);
  float wander = 0.16 * (other - 0.5);
  float surface = lobe(normalize(along + (0.12 + wander) * out_of_body), half_way, 55.0);
  float within = lobe(normalize(along - (0.20 + wander) * out_of_body), half_way, 13.0);
  float against = max(-dot(to_eye, to_sun.xyz), 0.0);
  float rim = 1.0 - abs(dot(out_of_body, to_eye));

  vec3 sum = albedo * mix(vec3(1.0), vec3(1.10, 0.92, 0.76), deep) * soft_light(out_of_body) * open_sky;  // coloured by the hairs that it passes
  sum += albedo * fire_light(place, out_of_body) * open_sky;
  sum += albedo * sun_light.rgb * (0.80 * across_sun * lit);
  sum += sun_light.rgb * lit * (vec3(0.085) * surface + albedo * (0.55 * within)) * smoothstep(-0.1, 0.3, sun_up);
  sum += albedo * sun_light.rgb * (0.9 * rim * rim * against * against * t * mix(0.4, 1.0, lit) * sun_through);
  shade = seen(sum, place);
}
