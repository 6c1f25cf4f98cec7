#include "water.part.glsl"
// For pictures that the processor draws: textures are not blended between two levels, and there is no shadow map, whose
// lookups would cost as much as with one.
float level(float lod) { return floor(lod + 0.5); }
float sun_on_water(vec3 place_m) { return 1.0; }
