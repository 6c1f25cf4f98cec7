#include "sward.part.glsl"
#include "ground.part.glsl"
float sun_on_ground(vec3 place_m) { return sunlight_at(place_m, pixel_chance(gl_FragCoord.xy)); }
