#pragma once
// In place of epoxy's header: WebGL 2 as emscripten declares it, OpenGL ES 3.0, and what epoxy knows of a context.
#include <cstring>

#include <GLES3/gl3.h>

#include <GLES2/gl2ext.h>

inline bool epoxy_is_desktop_gl() {
  return false;
}
inline int epoxy_gl_version() {
  return 30;
}
inline bool epoxy_has_gl_extension(const char* name) {
  const auto* const all = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  return all != nullptr && std::strstr(all, name) != nullptr;
}
