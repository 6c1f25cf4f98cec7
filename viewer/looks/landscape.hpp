#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/look/cloth_look.hpp"
#include "engine/look/look.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/gl/texel_buffer.hpp"
#include "viewer/light/light.hpp"
#include "viewer/looks/cloud_map.hpp"
#include "viewer/looks/small_sky.hpp"
#include "viewer/meshes/far_country.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::looks {

/// The ground, the far country and the sky around the scenes. Drawn after the scenes, so that hidden parts are not
/// painted. Needs a current context.
class Landscape {
 public:
  Landscape();

  /// With low quality the hills have fewer corners, and the sky is a SmallSky.
  void set_quality(look::Quality quality);

  /// Sets the image on bare ground, and its visible share, 0 to 1; null: none.
  void set_ground_image(const std::shared_ptr<const look::Image>& image, float share);

  /// Call before a picture of this size in this light, with its `view` (ViewBuffer::set) bound. Binds another
  /// framebuffer.
  void prepare(const light::Light& light, const meshes::View& view, int width_px, int height_px);

  /// The View and the GroundMaps are bound. The ground has holes where the stencil has kHole.
  void draw_ground();
  /// The hills and the sky of the picture.
  void draw_sky(const meshes::View& view);
  /// The same without the sky.
  void draw_hills(const meshes::View& view);
  /// The same of a mirror, whose View is bound.
  void draw_mirrored_sky(const meshes::View& view);

 private:
  void draw_far_country(const meshes::View& view);
  template <class DrawSky>
  void draw_behind(const meshes::View& view, DrawSky&& draw_sky);

  look::Quality quality_ = look::Quality::kLow;
  light::Light light_;
  gl::Texture noise_, relief_;
  CloudMap clouds_;
  gl::Program ground_;
  gl::Program plain_ground_;                  // with low quality
  std::shared_ptr<const look::Image> image_;  // on the ground
  std::optional<gl::Texture> image_texture_;
  float image_share_ = 0.0F;
  gl::Program hills_;
  GLint range_place_ = -1, every_place_ = -1;
  std::vector<gl::TexelBuffer> ranges_;  // corners of each of kFarRanges
  gl::Program sky_;
  std::optional<SmallSky> small_sky_{std::in_place};  // with low quality
  gl::VertexArray no_attributes_;
};

}  // namespace yuragi::viewer::looks
