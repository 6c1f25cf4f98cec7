#include "viewer/looks/small_sky.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr int kPixel_px = 3;              // one of its pixels is as wide and high as this many of the picture
constexpr GLsizei kSmallSkyColumns = 40;  // of sky.vert.glsl
constexpr GLsizei kSmallSkyRows = 24;
constexpr float kSun_rad = 0.03F;  // and its edge
constexpr float kMoon_rad = 0.012F;
constexpr float kMoonGlow_rad = 0.21F;

/// In pixels, from the picture's lower left corner.
struct Square {
  glm::ivec2 corner_px{0};
  int side_px = 0;
};

/// The square around an object of this size in a direction; nullopt if it is behind the eye.
std::optional<Square> square_around(const meshes::View& view, const glm::vec3& direction, float radius_rad,
                                    const glm::vec2& picture_px) {
  const float ahead = glm::dot(direction, glm::vec3(view.forward));
  if (ahead < 0.1F) return std::nullopt;
  const glm::vec2 at(glm::dot(direction, glm::vec3(view.right)) / view.right.w,
                     glm::dot(direction, glm::vec3(view.up)) / view.up.w);
  const float radius_px = 1.0F + radius_rad / (view.eye_m.w * ahead * ahead);  // wider toward the picture's edge
  const glm::vec2 corner_px = (0.5F + 0.5F * at / ahead) * picture_px - radius_px;
  return Square{.corner_px = glm::ivec2(glm::clamp(corner_px, -1e6F, 1e6F)),
                .side_px = static_cast<int>(2.0F * radius_px) + 2};
}

/// The lowest position of the sky in the picture, 0 to 1: a little below the horizon, for a high eye.
float horizon_of(const meshes::View& view) {
  const float dip = 0.06F + std::max(view.eye_m.y, 0.0F) / 1000.0F;  // the ground ends before the horizon
  if (view.up.y < 0.1F) return 0.0F;
  const float aside = std::abs(view.right.y * view.right.w);
  return 0.5F - 0.5F * (view.forward.y + aside + dip) / (view.up.y * view.up.w);
}

}  // namespace

SmallSky::SmallSky()
    : small_(gl::link_program("small sky", gl::shaders::kSkyVert, gl::shaders::kSmallSkyFrag)),
      wide_(gl::link_program("wide sky", gl::shaders::kWideSkyVert, gl::shaders::kWideSkyFrag)),
      wide_heavens_(gl::link_program("wide heavens", gl::shaders::kWideSkyVert, gl::shaders::kWideHeavensFrag)) {
  gl::set_sampler(small_, "noise_tile", 0);
  gl::set_sampler(wide_, "small_sky", gl::kSmallSkyUnit);
  gl::set_sampler(wide_heavens_, "small_sky", gl::kSmallSkyUnit);
  gl::set_sampler(wide_heavens_, "moon_spots", 0);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void SmallSky::make(const meshes::View& view, const CloudMap& clouds, const gl::Texture& noise, int width_px,
                    int height_px) {
  picture_px_ = {width_px, height_px};
  const glm::ivec2 size_px = (picture_px_ + kPixel_px - 1) / kPixel_px;
  glActiveTexture(GL_TEXTURE0 + gl::kSmallSkyUnit);
  glBindTexture(GL_TEXTURE_2D, 0);  // must not be read while it is drawn
  glActiveTexture(GL_TEXTURE0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  if (size_px != size_px_) {
    size_px_ = size_px;
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size_px.x, size_px.y, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.name(), 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw std::runtime_error("the graphics driver cannot draw a sky into a texture");
    }
  }
  glBindTexture(GL_TEXTURE_2D, noise.name());
  glViewport(0, 0, size_px.x, size_px.y);
  const int foot_px = std::clamp(static_cast<int>(horizon_of(view) * static_cast<float>(size_px.y)) - 2, 0, size_px.y);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, foot_px, size_px.x, size_px.y - foot_px);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glUseProgram(small_.name());
  clouds.bind(small_);
  glBindVertexArray(no_attributes_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * (kSmallSkyColumns + 1), kSmallSkyRows);
  glDisable(GL_SCISSOR_TEST);
  glActiveTexture(GL_TEXTURE0 + gl::kSmallSkyUnit);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glActiveTexture(GL_TEXTURE0);
}

void SmallSky::draw(const light::Light& light, const meshes::View& view) {
  glBindVertexArray(no_attributes_.name());
  const auto draw = [&](const gl::Program& program) {
    glUseProgram(program.name());
    const glm::vec2 pixel = 1.0F / glm::vec2(picture_px_);
    glUniform2f(glGetUniformLocation(program.name(), "pixel"), pixel.x, pixel.y);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  };
  if (light.air.w > 0.0F) {
    draw(wide_heavens_);  // stars are everywhere
    return;
  }
  draw(wide_);
  const auto draw_around = [&](const glm::vec4& disc, float radius_rad) {
    if (disc.w <= 0.0F) return;
    const auto square = square_around(view, glm::vec3(disc), radius_rad, glm::vec2(picture_px_));
    if (!square) return;
    glEnable(GL_SCISSOR_TEST);
    glScissor(square->corner_px.x, square->corner_px.y, square->side_px, square->side_px);
    draw(wide_heavens_);
    glDisable(GL_SCISSOR_TEST);
  };
  draw_around(light.sun_disc, kSun_rad);
  draw_around(light.moon_disc, light.sun_disc.y < 0.0F ? kMoonGlow_rad : kMoon_rad);
}

}  // namespace yuragi::viewer::looks
