#pragma once

#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/strand_ribbons.hpp"

namespace yuragi::viewer::looks {

/// Draws strands as the coat of an animal: underhair and guard hairs, several around each strand, over a pale skin that
/// is seen where the coat parts.
class FurRenderer : public SceneRenderer {
 public:
  /// `strands` must outlive this. The better the quality, the more hairs.
  FurRenderer(const pose::StrandSkeleton& strands, look::Quality quality);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void draw_shadow(const meshes::View& view) override;
  bool casts_shadow() const override { return true; }

 private:
  void draw_skin() const;

  StrandRibbons ribbons_;
  gl::GlProgram hair_;
  gl::GlProgram skin_;
  GLsizei skin_count_ = 0;
  gl::GlTexture noise_;
  gl::GlVertexArray skin_array_;
  gl::GlBuffer skin_buffer_, skin_indices_;
};

}  // namespace yuragi::viewer::looks
