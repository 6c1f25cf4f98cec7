#include "sward.part.glsl"
#include "ground.part.glsl"
// For hard shadows. llvmpipe computes both sides of a branch: it would look for the penumbra, too.
float sun_on_ground(vec3 place_m) { return sunlight_near(place_m); }
