#pragma once

#include <optional>

#include "viewer/looks/scene_renderer.hpp"
#include "viewer/looks/strand_ribbons.hpp"
#include "viewer/meshes/body.hpp"
#include "viewer/meshes/partings.hpp"
#include "viewer/meshes/sleeper.hpp"

namespace yuragi::viewer::looks {

/// Draws strands as the coat of an animal: underhair and guard hairs, several around each strand, over a pale skin that
/// is visible where the coat parts. A body that is long enough is a sleeping animal: it also has limbs with a shorter
/// coat (meshes::limbs_of).
class FurRenderer : public SceneRenderer {
 public:
  /// `strands` must outlive this. A better quality has more hairs.
  FurRenderer(const pose::StrandSkeleton& strands, look::Quality quality);

  void move_to(const pose::Pose& pose) override;
  void draw(const meshes::View& view) override;
  void draw_shadow(const meshes::View& view) override;
  meshes::Bounds bounds_with_holder(const meshes::Bounds& bounds) const override {
    return limb_bounds_ ? meshes::united(bounds, *limb_bounds_) : bounds;
  }
  meshes::CameraPlace outside(const meshes::CameraPlace& place) const override {
    return skin_count_ > 0 ? meshes::outside(body_, place) : place;
  }
  bool casts_shadow() const override { return true; }

 private:
  /// `hair_share`: the share of the hairs on limbs to draw, 0 to 1.
  void draw_skin(float hair_share) const;
  void make_limbs(const meshes::Limbs& limbs);

  bool do_hairs_shade_;  ///< with quality low hairs receive no shadows
  meshes::Body body_;
  StrandRibbons ribbons_;
  meshes::Partings partings_;
  gl::Program hair_;
  gl::Program skin_;
  GLsizei skin_count_ = 0;
  gl::Texture noise_;
  gl::VertexArray skin_array_;
  gl::Buffer skin_buffer_, skin_indices_;

  std::optional<meshes::Bounds> limb_bounds_;
  GLsizei limb_count_ = 0, limb_hair_count_ = 0;
  float limb_hair_m_ = 0.0F;
  gl::Program limb_;
  GLint is_hair_ = -1, wider_ = -1;
  gl::VertexArray limb_array_;
  gl::Buffer limb_buffer_, limb_indices_;
};

}  // namespace yuragi::viewer::looks
