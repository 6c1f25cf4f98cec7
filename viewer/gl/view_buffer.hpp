#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::gl {

/// The uniform buffer that holds a View. Needs a current context.
class ViewBuffer {
 public:
  void set(const meshes::View& view);

 private:
  GlBuffer buffer_;
};

}  // namespace yuragi::viewer::gl
