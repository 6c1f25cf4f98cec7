#include "viewer/picture/gl_renderer.hpp"

#include <utility>

namespace yuragi::viewer::picture {

GlRenderer::GlRenderer(std::shared_ptr<void> context, int width_px, int height_px, int samples)
    : context_(std::move(context)), samples_(samples), target_(width_px, height_px, samples) {}

void GlRenderer::resize(int width_px, int height_px) {
  if (target_.width_px() == width_px && target_.height_px() == height_px) return;
  target_ = gl::RenderTarget(width_px, height_px, samples_);
}

void GlRenderer::set_quality(look::Quality quality, float density) {
  wanted_quality_ = quality;
  quality_ = quality == look::Quality::kAuto ? own_quality_ : quality;
  density_ = density;
  stage_.set_quality(quality_);
}

void GlRenderer::draw(const Picture& picture) {
  stage_.set_blade_share(drawn_.blades * density_);
  stage_.set_coarseness(drawn_.coarseness);
  target_.set_drawn_side(drawn_.side);
  if (picture.fading_out) {
    camera_.go_to(*picture.fading_out);
    stage_.draw(picture.moment, camera_, target_);
    cross_fade_.keep(target_);
  }
  camera_.go_to(picture.camera);
  stage_.draw(picture.moment, camera_, target_);
  if (picture.fading_out) cross_fade_.draw(target_, picture.share);
  if (quality_ == look::Quality::kLow && target_.samples() == 1) edge_smoother_.draw(target_);
}

}  // namespace yuragi::viewer::picture
