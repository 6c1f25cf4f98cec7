#include "viewer/looks/landscape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "viewer/gl/noise_texture.hpp"
#include "viewer/gl/screen_door.hpp"
#include "viewer/gl/shaders.hpp"
#include "viewer/looks/ground_maps.hpp"
#include "viewer/looks/image_texture.hpp"

namespace yuragi::viewer::looks {
namespace {

// The shaders have the same numbers.
constexpr GLsizei kSkyColumns = 40;
constexpr GLsizei kSkyRows = 24;

// Minimum distance of a hill's corners in the picture, and a factor for hills without trees.
constexpr float kCorner_px = 0.75F;
constexpr float kLowCorner_px = 2.2F;
constexpr float kBareHill = 3.0F;

/// The bearings between which a circle around the world's middle is in view. Nullopt if the picture ends below the
/// horizon.
std::optional<meshes::Arc> arc_in_view(const meshes::View& view, float radius_m) {
  float highest = -1.0F;
  for (const glm::vec3& ray : meshes::corner_rays(view)) highest = std::max(highest, ray.y / glm::length(ray));
  const float out_m = glm::length(glm::vec2(view.eye_m.x, view.eye_m.z));
  if (highest < -view.eye_m.y / std::max(radius_m - out_m, 1.0F)) return std::nullopt;
  // From a place beside the middle it is seen in other directions.
  const float aside_rad = out_m < radius_m ? std::asin(out_m / radius_m) : glm::pi<float>();
  return meshes::widened(meshes::bearings_of(view), aside_rad + 0.01F);
}

}  // namespace

Landscape::Landscape()
    : noise_(gl::make_noise_texture()),
      relief_(gl::make_relief_texture()),
      ground_(gl::link_program("ground", gl::shaders::kGroundVert, gl::shaders::kGroundFrag)),
      plain_ground_(gl::link_program("plain ground", gl::shaders::kGroundVert, gl::shaders::kPlainGroundFrag)),
      hills_(gl::link_program("hills", gl::shaders::kHillsVert, gl::shaders::kHillsFrag)),
      sky_(gl::link_program("sky", gl::shaders::kSkyVert, gl::shaders::kSkyFrag)) {
  for (const gl::Program* ground : {&ground_, &plain_ground_}) {
    GroundMaps::set_samplers(*ground);
    gl::set_sampler(*ground, "ground_image", gl::kGroundImageUnit);
  }
  gl::set_sampler(sky_, "noise_tile", 0);
  gl::set_sampler(sky_, "moon_spots", 0);
  gl::set_sampler(hills_, "relief_tile", 0);
  gl::set_sampler(hills_, "corners", gl::kTilesUnit);
  range_place_ = glGetUniformLocation(hills_.name(), "range");
  every_place_ = glGetUniformLocation(hills_.name(), "every");
  for (std::size_t range = 0; range < meshes::kFarRanges.size(); ++range) {
    const std::vector<meshes::FarCorner> corners = meshes::far_corners(range);
    ranges_.emplace_back(GL_RGBA32F).fill(std::span(corners));
  }
}

void Landscape::set_quality(look::Quality quality) {
  quality_ = quality;
  small_sky_.reset();
  if (quality == look::Quality::kLow) small_sky_.emplace();
}

void Landscape::set_ground_image(const std::shared_ptr<const look::Image>& image, float share) {
  image_share_ = image != nullptr ? share : 0.0F;
  if (image == image_) return;
  image_ = image;
  image_texture_.reset();
  if (image_ != nullptr) image_texture_.emplace(image_texture(*image_, GL_REPEAT));
}

void Landscape::prepare(const light::Light& light, const meshes::View& view, int width_px, int height_px) {
  light_ = light;
  clouds_.advance(light, noise_, view);
  if (small_sky_) small_sky_->make(view, clouds_, noise_, width_px, height_px);
}

/// Ranges from near to far, so that hidden parts are not painted.
void Landscape::draw_far_country(const meshes::View& view) {
  glUseProgram(hills_.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, relief_.name());
  for (std::size_t range = 0; range < ranges_.size(); ++range) {
    const meshes::FarRange& form = meshes::kFarRanges.at(range);
    const std::optional<meshes::Arc> arc = arc_in_view(view, form.distance_m - form.distance_varies_m);
    if (!arc) continue;
    const float apart_px =
        (quality_ == look::Quality::kLow ? kLowCorner_px : kCorner_px) * (form.trees_m > 0.0F ? 1.0F : kBareHill);
    const int every = meshes::far_corner_step(apart_px * view.eye_m.w);
    const int around = meshes::kFarCorners / every;
    const float step_rad = glm::two_pi<float>() / static_cast<float>(around);
    glUniform1i(range_place_, static_cast<GLint>(range));
    glUniform1i(every_place_, every);
    ranges_[range].bind(gl::kTilesUnit);
    const auto first = static_cast<GLint>(arc->from_rad / step_rad) % around;
    const auto count = static_cast<GLsizei>(std::ceil(arc->size_rad / step_rad)) + 2;
    // More than half of the circle: all of it.
    const bool is_all = count > around / 2;
    glDrawArrays(GL_TRIANGLE_STRIP, is_all ? 0 : 2 * first, 2 * (is_all ? around + 1 : count));
  }
  glActiveTexture(GL_TEXTURE0);
}

void Landscape::draw_ground() {
  glBindVertexArray(no_attributes_.name());
  const gl::Program& ground = quality_ == look::Quality::kLow ? plain_ground_ : ground_;
  glUseProgram(ground.name());
  glUniform1i(glGetUniformLocation(ground.name(), "images"), image_share_ > 0.0F ? 1 : 0);
  if (image_share_ > 0.0F) {
    const float tall_per_wide = static_cast<float>(image_->height_px) / static_cast<float>(image_->width_px);
    glUniform2f(glGetUniformLocation(ground.name(), "image_form"), image_share_, tall_per_wide);
    glActiveTexture(GL_TEXTURE0 + gl::kGroundImageUnit);
    glBindTexture(GL_TEXTURE_2D, image_texture_->name());
    glActiveTexture(GL_TEXTURE0);
  }
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glStencilFunc(GL_EQUAL, 0, gl::kHole);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_STENCIL_TEST);
}

template <class DrawSky>
void Landscape::draw_behind(const meshes::View& view, DrawSky&& draw_sky) {
  draw_hills(view);
  glBindTexture(GL_TEXTURE_2D, noise_.name());
  // The sky is at the far end of the depth range.
  glDepthFunc(GL_LEQUAL);
  draw_sky();
  glDepthFunc(GL_LESS);
}

void Landscape::draw_hills(const meshes::View& view) {
  glBindVertexArray(no_attributes_.name());
  draw_far_country(view);
}

void Landscape::draw_sky(const meshes::View& view) {
  if (!small_sky_) return draw_mirrored_sky(view);
  draw_behind(view, [&] { small_sky_->draw(light_, view); });
}

void Landscape::draw_mirrored_sky(const meshes::View& view) {
  draw_behind(view, [&] {
    glUseProgram(sky_.name());
    clouds_.bind(sky_);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * (kSkyColumns + 1), kSkyRows);
  });
}

}  // namespace yuragi::viewer::looks
