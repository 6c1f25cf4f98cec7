#pragma once

#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/strand_ribbons.hpp"

namespace yuragi::viewer::looks {

/// Draws strands as the coat of an animal: fine hairs over a dark undercoat that hides the body's inside.
class FurRenderer : public SceneRenderer {
 public:
  /// `strands` must outlive this.
  explicit FurRenderer(const pose::StrandSkeleton& strands);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  bool casts_shadow() const override { return true; }

 private:
  StrandRibbons ribbons_;
  gl::GlProgram hair_;
  gl::GlProgram undercoat_;
};

}  // namespace yuragi::viewer::looks
