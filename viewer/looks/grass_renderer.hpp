#pragma once

#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/strand_ribbons.hpp"

namespace yuragi {

/// Draws strands as a meadow of lit blades.
class GrassRenderer : public SceneRenderer {
 public:
  /// `strands` must outlive this.
  explicit GrassRenderer(const StrandSkeleton& strands);

  void move_to(const Pose& pose) override;
  void draw(const View& view) override;
  bool is_field() const override { return true; }

 private:
  StrandRibbons ribbons_;
  GlProgram program_;
};

}  // namespace yuragi
