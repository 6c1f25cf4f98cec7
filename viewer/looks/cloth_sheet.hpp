#pragma once

#include <vector>

#include "viewer/gl/gl.hpp"
#include "viewer/meshes/cloth_surface.hpp"

namespace yuragi::viewer::looks {

/// The triangles of a cloth on the GPU, at one level of detail (ClothSurface), and of the rim around it. Needs a
/// current context.
///
/// Attributes: the point 0 to 2 (x, y, z, metres), its normal 3 to 5, the bend of the cloth there 6
/// (ClothSurface::write_bends), the place on the cloth 7 and 8. Allocates nothing after it is made.
class ClothSheet {
 public:
  ClothSheet(const meshes::GridLayout& joints, const meshes::ClothMeasure& lies, int level, int finer_down);

  /// Takes the joints' present positions: all x, then all y, then all z.
  void move_to(std::span<const float> joints);

  /// Draws the cloth with the program in use.
  void draw() const;
  /// Draws its rim. The first call after move_to() sets its thickness.
  void draw_rim(float half_thickness_m);

 private:
  meshes::ClothMeasure lies_;
  meshes::ClothSurface surface_;
  std::vector<float> bends_per_m_, rim_points_, rim_normals_;
  bool is_rim_there_ = false;  ///< for the present positions
  GLsizei index_count_ = 0;
  gl::Buffer index_buffer_, point_buffer_, normal_buffer_, bend_buffer_, place_buffer_;
  gl::Buffer rim_point_buffer_, rim_normal_buffer_, rim_place_buffer_;
  gl::VertexArray array_, rim_array_;
};

}  // namespace yuragi::viewer::looks
