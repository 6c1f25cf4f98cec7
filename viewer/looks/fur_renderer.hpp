#pragma once

#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/strand_ribbons.hpp"

namespace yuragi {

/// Draws strands as the coat of an animal: fine hairs over a dark undercoat that hides the body's inside.
class FurRenderer : public SceneRenderer {
 public:
  /// `strands` must outlive this.
  explicit FurRenderer(const StrandSkeleton& strands);

  void move_to(const Pose& pose) override;
  void draw(const View& view) override;
  bool casts_shadow() const override { return true; }

 private:
  StrandRibbons ribbons_;
  GlProgram hair_;
  GlProgram undercoat_;
};

}  // namespace yuragi
