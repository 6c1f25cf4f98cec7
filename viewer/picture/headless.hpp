#pragma once

#include <memory>

#include "viewer/gl/headless_context.hpp"

namespace yuragi::viewer::picture {

/// Returns a current context that needs no display. Throws ViewerExit (EX_UNAVAILABLE) if there is none.
std::unique_ptr<gl::HeadlessContext> make_headless_context();

}  // namespace yuragi::viewer::picture
