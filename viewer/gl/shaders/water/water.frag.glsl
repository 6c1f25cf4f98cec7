#include "water.part.glsl"
float level(float lod) { return lod; }
float sun_on_water(vec3 place_m) { return sunlight_at(place_m, pixel_chance(gl_FragCoord.xy)); }
