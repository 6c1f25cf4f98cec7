#pragma once

#include <optional>
#include <span>

#include "viewer/gl/gl.hpp"
#include "viewer/gl/view_buffer.hpp"
#include "viewer/meshes/trees/sprays.hpp"
#include "viewer/meshes/trees/tree_impostor.hpp"

namespace yuragi::viewer::looks {

/// How the leaves of a tree take on colors (foliage.part.glsl).
struct LeafColors {
  bool has_palette = false;  ///< they take the palette's
  float turns_red = 0.0F;    ///< how far they turn in autumn, 0 to 1
  float silver = 0.0F;       ///< how pale their lower faces are, 0 to 1
  void set(const gl::Program& program) const;
};

/// The pictures of a tree from all sides, and the sheets far away that show them: one draw call for a whole grove. The
/// pictures hold colors and normals, so that the sheets follow the light. Needs a current context.
class TreeImpostors {
 public:
  /// `box` and `foot_m`: of the tree at its place.
  TreeImpostors(const meshes::trees::ImpostorBox& box, const glm::vec3& foot_m, meshes::trees::SprayShape::Kind kind,
                const LeafColors& colors);

  /// Makes all pictures: draw(view) is called for each, with a framebuffer of color and normal bound.
  template <class Draw>
  void make(gl::ViewBuffer& views, Draw&& draw) {
    begin();
    for (std::size_t row = 0; row < meshes::trees::kImpostorRows; ++row) {
      for (std::size_t side = 0; side < meshes::trees::kImpostorSides; ++side) draw(begin_picture(views, side, row));
    }
    end();
  }

  /// Draws sheets, which face the eye or, for their shadows, the sun.
  /// `blown`: the mean turn of their sprays from rest by the wind (SprayPlace).
  void draw(std::span<const meshes::trees::Impostor> trees, float blown, bool is_by_sun);

 private:
  void begin();
  meshes::View begin_picture(gl::ViewBuffer& views, std::size_t side, std::size_t row);
  void end();

  meshes::trees::ImpostorBox box_;
  glm::vec3 to_middle_m_;
  meshes::trees::SprayShape::Kind kind_;
  LeafColors colors_;
  gl::Texture looks_, facing_;
  /// The buffers in which the pictures are drawn, besides these two.
  struct Canvas {
    gl::Renderbuffer depth;
    gl::Framebuffer framebuffer;
  };
  std::optional<Canvas> canvas_;  // while they are made
  gl::Buffer trees_;
  gl::VertexArray array_;
  gl::Program program_;
};

}  // namespace yuragi::viewer::looks
