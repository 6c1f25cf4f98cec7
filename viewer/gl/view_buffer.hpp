#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/light/fire_light.hpp"
#include "viewer/light/light.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::gl {

/// The uniform buffers that hold a View, a Light and Fires. Needs a current context.
class ViewBuffer {
 public:
  void set(const meshes::View& view);
  void set(const light::Light& light);
  void set(const light::Fires& fires);

 private:
  Buffer view_;
  Buffer light_;
  Buffer fires_;
};

}  // namespace yuragi::viewer::gl
