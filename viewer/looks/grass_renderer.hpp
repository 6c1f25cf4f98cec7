#pragma once

#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/strand_ribbons.hpp"

namespace yuragi::viewer::looks {

/// Draws strands as a meadow of lit blades.
class GrassRenderer : public SceneRenderer {
 public:
  /// `strands` must outlive this.
  explicit GrassRenderer(const pose::StrandSkeleton& strands);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  bool is_field() const override { return true; }

 private:
  StrandRibbons ribbons_;
  gl::GlProgram program_;
};

}  // namespace yuragi::viewer::looks
