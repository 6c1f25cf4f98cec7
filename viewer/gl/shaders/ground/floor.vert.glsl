// A floor of boards: a flat box, without attributes.
uniform vec3 middle_m;  // of its upper side
uniform vec2 along;     // x, z: a unit vector, across which its boards lie
uniform vec2 half_m;    // along it, and along its boards

out vec3 place_m;
out vec3 normal;
out float unshaded;
out float thin;

// Of each of its sides but the lower one: two triangles.
const vec2 kAround[6] = vec2[6](vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(-1.0, 1.0), vec2(-1.0, 1.0), vec2(1.0, -1.0), vec2(1.0, 1.0));

void main() {
  unshaded = 1.0;
  thin = 0.7;  // what holds the cloth lets nothing through
  int side = gl_VertexID / 6;
  vec2 at = kAround[gl_VertexID % 6];
  vec3 corner = vec3(at.x, 0.0, at.y);
  vec3 out_of = vec3(0.0, 1.0, 0.0);
  if (side > 0) {
    float sign = side > 2 ? -1.0 : 1.0;
    bool is_end = side % 2 == 0;
    corner = is_end ? vec3(at.x, 0.5 * at.y - 0.5, sign) : vec3(sign, 0.5 * at.y - 0.5, at.x);
    out_of = is_end ? vec3(0.0, 0.0, sign) : vec3(sign, 0.0, 0.0);
  }
  vec3 ahead = vec3(-along.y, 0.0, along.x);
  vec3 aside = vec3(along.x, 0.0, along.y);
  place_m = middle_m + corner.x * half_m.x * aside + corner.z * half_m.y * ahead;
  place_m.y = mix(middle_m.y, -0.02, -corner.y);
  normal = out_of.x * aside + out_of.y * vec3(0.0, 1.0, 0.0) + out_of.z * ahead;
  gl_Position = to_clip * vec4(place_m, 1.0);
}
