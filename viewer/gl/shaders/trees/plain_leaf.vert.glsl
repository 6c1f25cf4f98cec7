#include "foliage.part.glsl"
#include "leaf.part.glsl"
// For quality low, in which shadows fall on the ground only.
bool is_lit() { return true; }
float sun_seen_in_map(float sun_seen, vec3 place) { return sun_seen; }
