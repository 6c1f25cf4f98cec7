#include "viewer/looks/cloud_map.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr int kRows = 256;  // the shader has the same number

constexpr int kColumnsInAHurry = 64;  // while the sky changes

constexpr float kFilter_rad = 0.02F;   // columns aside that a filter reaches into
constexpr float kDriftedAside = 6.0F;  // maximum sideways displacement of clouds in the map, as a part of their drift

constexpr float kMinSun = -0.12F;  // sine of its height; at lower heights the moon lights the clouds

}  // namespace

CloudMap::CloudMap() : program_(gl::link_program("clouds", gl::shaders::kDoorVert, gl::shaders::kCloudsFrag)) {
  gl::set_sampler(program_, "noise_tile", 0);
  for (const Map& map : maps_) {
    glBindTexture(GL_TEXTURE_2D, map.texture.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kColumns, kRows, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
}

CloudMap::Sky CloudMap::sky_of(const light::Light& light) {
  return {.drift = {light.drift.x, light.drift.y},
          .clouds_begin = light.air.z,
          .to_sun = glm::vec3(light.sun_disc.y > kMinSun ? light.sun_disc : light.to_sun)};
}

void CloudMap::draw_columns(const Map& map, int first, int count) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, map.texture.name(), 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("the graphics driver cannot draw clouds into a texture");
  }
  glViewport(0, 0, kColumns, kRows);
  glEnable(GL_SCISSOR_TEST);
  glScissor(first, 0, count, kRows);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glUseProgram(program_.name());
  glUniform3f(glGetUniformLocation(program_.name(), "cover"), map.sky.drift.x, map.sky.drift.y, map.sky.clouds_begin);
  glUniform3f(glGetUniformLocation(program_.name(), "sun_then"), map.sky.to_sun.x, map.sky.to_sun.y, map.sky.to_sun.z);
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
}

/// Draws the missing strips from `first` up to `end`.
void CloudMap::draw_missing(std::size_t first, std::size_t end) {
  while (first < end) {
    std::size_t next = first;
    while (next < end && missing_[next]) missing_.reset(next++);
    if (next > first) {
      draw_columns(maps_.at(to_), static_cast<int>(first) * kStripColumns,
                   static_cast<int>(next - first) * kStripColumns);
    }
    first = next + 1;
  }
}

void CloudMap::draw_missing(const meshes::Arc& bearings) {
  constexpr float kStrip_rad = glm::two_pi<float>() / static_cast<float>(kStrips);
  const auto first = static_cast<std::size_t>(bearings.from_rad / kStrip_rad);
  const auto end = static_cast<std::size_t>((bearings.from_rad + bearings.size_rad) / kStrip_rad) + 1;
  draw_missing(std::min(first, kStrips), std::min(end, kStrips));
  if (end > kStrips) draw_missing(0, std::min(end - kStrips, kStrips));  // around the map's edge
}

void CloudMap::advance(const light::Light& light, const gl::Texture& noise, const meshes::View& view) {
  const auto is_nearly = [](const Sky& a, const Sky& b, float tolerance) {
    return glm::distance(a.drift, b.drift) < 5.0F * tolerance && glm::distance(a.to_sun, b.to_sun) < 2.0F * tolerance &&
           std::abs(a.clouds_begin - b.clouds_begin) < tolerance;
  };
  const Sky before = std::exchange(now_, sky_of(light));
  for (const GLint unit : {gl::kCloudsFromUnit, gl::kCloudsToUnit}) {  // must not be read while they are drawn
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, 0);
  }
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, noise.name());

  if (is_first_ || !is_nearly(before, now_, 0.04F)) {
    is_first_ = false;
    maps_.at(to_).sky = now_;
    missing_.set();
    swept_ = 0;
    from_ = to_;
    next_ = to_ == 0 ? 1 : 0;
    drawn_ = 0;
  }
  const int wanted = is_nearly(maps_.at(to_).sky, now_, 0.015F) ? kStripColumns : kColumnsInAHurry;
  if (missing_.any()) {
    const float drifted_rad = kDriftedAside * glm::distance(maps_.at(to_).sky.drift, now_.drift);
    draw_missing(meshes::widened(meshes::bearings_of(view, meshes::kMirrorMargin), kFilter_rad + drifted_rad));
    const std::size_t swept = std::min(swept_ + static_cast<std::size_t>(wanted / kStripColumns), kStrips);
    draw_missing(std::exchange(swept_, swept), swept);  // for views to come
    return;
  }
  if (drawn_ == 0) maps_.at(next_).sky = now_;
  const int count = std::min(wanted, kColumns - drawn_);
  draw_columns(maps_.at(next_), drawn_, count);
  drawn_ += count;
  if (drawn_ < kColumns) return;
  drawn_ = 0;
  from_ = std::exchange(to_, next_);
  next_ = 3 - from_ - to_;
}

void CloudMap::bind(const gl::Program& sky) const {
  const auto show = [&](GLint unit, const Map& map, const char* sampler, const char* drifted) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, map.texture.name());
    glUniform1i(glGetUniformLocation(sky.name(), sampler), unit);
    const glm::vec2 since = now_.drift - map.sky.drift;
    glUniform2f(glGetUniformLocation(sky.name(), drifted), since.x, since.y);
  };
  show(gl::kCloudsFromUnit, maps_.at(from_), "clouds_from", "drifted_from");
  show(gl::kCloudsToUnit, maps_.at(to_), "clouds_to", "drifted_to");
  glUniform1f(glGetUniformLocation(sky.name(), "clouds_share"),
              from_ == to_ ? 1.0F : static_cast<float>(drawn_) / static_cast<float>(kColumns));
  glActiveTexture(GL_TEXTURE0);
}

}  // namespace yuragi::viewer::looks
