#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/light/light.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::gl {

/// The uniform buffers that hold a View and a Light. Needs a current context.
class ViewBuffer {
 public:
  void set(const meshes::View& view);
  void set(const light::Light& light);

 private:
  GlBuffer view_;
  GlBuffer light_;
};

}  // namespace yuragi::viewer::gl
