#pragma once

#include <string>
#include <vector>

namespace yuragi::viewer {

/// Environment variables that hold Mesa down to OpenGL 3.1 and to what its driver of a Raspberry Pi 4 has: neither
/// timers nor fences are to be counted on. Mesa reads them once a process. tests/pictures/CMakeLists.txt has them, too.
inline std::vector<std::string> opengl_31() {
  return {"MESA_GL_VERSION_OVERRIDE=3.1", "MESA_EXTENSION_OVERRIDE=-GL_ARB_timer_query -GL_ARB_sync"};
}

/// And to OpenGL 2.1, which Debian 12 has on a Raspberry Pi 4.
inline std::vector<std::string> opengl_21() {
  return {"MESA_GL_VERSION_OVERRIDE=2.1"};
}

}  // namespace yuragi::viewer
