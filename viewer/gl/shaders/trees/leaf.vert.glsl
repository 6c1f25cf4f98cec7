#include "foliage.part.glsl"
#include "leaf.part.glsl"
// The map of shadows knows the leaves as they are now.
bool is_lit() { return true; }
float sun_seen_in_map(float sun_seen, vec3 place) {
  return shadow.x > 0.0 ? mix(sun_seen, sunlight_near(place + 0.12 * to_sun.xyz), 0.6) : sun_seen;
}
