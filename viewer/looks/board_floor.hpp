#pragma once

#include "viewer/gl/gl.hpp"
#include "viewer/meshes/floor.hpp"

namespace yuragi::viewer::looks {

/// Draws a Floor. Needs a current context.
class BoardFloor {
 public:
  /// `through`: the share of the sun's light that passes through the shading object.
  BoardFloor(const meshes::Floor& floor, const glm::vec3& through);

  /// The View is bound (ViewBuffer::set).
  void draw() const;

  /// If there is no shadow map: draws in shade the part of the floor that the output of `draw_shapes`, flattened onto
  /// it, covers. The shader gets its points in the attributes 0 to 2 (x, y, z).
  template <class DrawShapes>
  void draw_in_shade(DrawShapes&& draw_shapes) const {
    glUseProgram(shade_program_.name());
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1.0F, -2.0F);
    draw_shapes();
    glDisable(GL_POLYGON_OFFSET_FILL);
  }

 private:
  gl::Program program_, shade_program_;
  gl::VertexArray no_attributes_;
};

}  // namespace yuragi::viewer::looks
