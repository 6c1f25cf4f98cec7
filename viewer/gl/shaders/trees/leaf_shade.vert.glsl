#include "foliage.part.glsl"
#include "leaf.part.glsl"
// For the map of shadows.
bool is_lit() { return false; }
float sun_seen_in_map(float sun_seen, vec3 place) { return sun_seen; }
