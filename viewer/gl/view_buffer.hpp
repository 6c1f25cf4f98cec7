#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi {

/// The uniform buffer that holds a View. Needs a current context.
class ViewBuffer {
 public:
  void set(const View& view);

 private:
  GlBuffer buffer_;
};

}  // namespace yuragi
