#pragma once

#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/strand_ribbons.hpp"
#include "viewer/meshes/sleeper.hpp"

namespace yuragi::viewer::looks {

/// Draws strands as the coat of an animal: underhair and guard hairs, several around each strand, over a pale skin that
/// is seen where the coat parts. A body that is long enough is an animal asleep: it has short-haired limbs besides
/// (meshes::limbs_of).
class FurRenderer : public SceneRenderer {
 public:
  /// `strands` must outlive this. The better the quality, the more hairs.
  FurRenderer(const pose::StrandSkeleton& strands, look::Quality quality);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void draw_shadow(const meshes::View& view) override;
  meshes::Bounds bounds_with_holder(const meshes::Bounds& bounds) const override;
  bool casts_shadow() const override { return true; }

 private:
  void draw_skin() const;
  void make_limbs();

  StrandRibbons ribbons_;
  gl::GlProgram hair_;
  gl::GlProgram skin_;
  GLsizei skin_count_ = 0;
  gl::GlTexture noise_;
  gl::GlVertexArray skin_array_;
  gl::GlBuffer skin_buffer_, skin_indices_;

  meshes::Limbs limbs_;
  gl::GlProgram limb_;
  gl::GlVertexArray limb_array_;
  gl::GlBuffer limb_buffer_, limb_indices_;
};

}  // namespace yuragi::viewer::looks
