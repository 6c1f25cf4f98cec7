#pragma once
// In place of epoxy's header: what WebGL 2 has of OpenGL (OpenGL ES 3.0), as emscripten declares it.
#include <GLES3/gl3.h>

#include <GLES2/gl2ext.h>
