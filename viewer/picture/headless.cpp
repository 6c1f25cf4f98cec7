#include "viewer/picture/headless.hpp"

#include <stdexcept>

#include "viewer/picture/viewer_exit.hpp"

namespace yuragi::viewer::picture {

std::unique_ptr<gl::HeadlessContext> make_headless_context() {
  try {
#ifdef YURAGI_GL_DEBUG
    auto context = std::make_unique<gl::HeadlessContext>(gl::HeadlessOptions{.has_messages = true});
    gl::report_gl_errors();
    return context;
#else
    return std::make_unique<gl::HeadlessContext>();
#endif
  } catch (const std::runtime_error& error) {
    throw ViewerExit(EX_UNAVAILABLE, error.what());
  }
}

}  // namespace yuragi::viewer::picture
