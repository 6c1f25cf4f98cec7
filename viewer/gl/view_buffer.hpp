#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi {

/// The View on the GPU.
class ViewBuffer {
 public:
  void set(const View& view);

 private:
  GlBuffer buffer_;
};

}  // namespace yuragi
