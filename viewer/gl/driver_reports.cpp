// What a driver of the desktop reports about itself, of gl.hpp: OpenGL ES 3.0 and WebGL 2 have none of these functions.

#include <atomic>
#include <cstdio>

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {
namespace {

std::atomic<int> error_count{0};

void GLAPIENTRY log_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                            const void*) {
  if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH) return;
  ++error_count;
  std::fprintf(stderr, "yuragi-viewer: OpenGL: %.*s\n", length, text);
}

}  // namespace

bool is_context_lost() {
  static const bool reports_reset =
      (epoxy_is_desktop_gl() && epoxy_gl_version() >= 45) || epoxy_has_gl_extension("GL_KHR_robustness");
  return reports_reset && glGetGraphicsResetStatus() != GL_NO_ERROR;
}

void report_gl_errors() {
  if (!epoxy_has_gl_extension("GL_KHR_debug") && !(epoxy_is_desktop_gl() && epoxy_gl_version() >= 43)) return;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(log_message, nullptr);
}

int gl_error_count() {
  return error_count;
}

}  // namespace yuragi::viewer::gl
