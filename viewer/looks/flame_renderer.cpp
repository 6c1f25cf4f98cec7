#include "viewer/looks/flame_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "viewer/gl/noise_texture.hpp"
#include "viewer/gl/shaders.hpp"
#include "viewer/meshes/bounds.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr std::size_t kRampColors = 256;
constexpr float kGlowPerHeight = 1.15F;  // the glow's radius

// Brightness of a flame as thick as its radius, in Light's unit: a wood fire is about as bright as a third of white
// paper in the sun.
constexpr float kBodyBrightness = 0.30F;
// Factor by day: otherwise sunlit grass outshines it.
constexpr float kDayBrightness = 3.2F;
constexpr float kSheetBrightness = 2.2F;
constexpr float kEmbersBrightness = 1.0F;
constexpr glm::vec3 kGlow{0.050F, 0.017F, 0.004F};
// Illumination of a surface at one metre, for each square metre of the flame's outline: its radiance over the pi of a
// diffuse surface.
constexpr glm::vec3 kFireLight{0.95F, 0.43F, 0.13F};
constexpr float kUsualHeat = 0.42F;  // mean of all points

// The time constant with which the shown axis follows the streamed one, so that a place does not flash (WCAG 2.3.1):
// flame_flash_test.cpp.
constexpr double kFollowing_s = 0.65;
constexpr double kJump_s = 1.0;

constexpr int kStepsLow = 16, kStepsMedium = 20, kStepsHigh = 28;

/// 0 by night, 1 by day.
float day_of(float flame_brightness) {
  return glm::smoothstep(0.4F, 1.8F, flame_brightness);
}

int steps_of(look::Quality quality) {
  if (quality == look::Quality::kLow) return kStepsLow;
  return quality == look::Quality::kMedium ? kStepsMedium : kStepsHigh;
}

void filter_linearly(GLenum target) {
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum axis : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}, GLenum{GL_TEXTURE_WRAP_R}}) {
    glTexParameteri(target, axis, GL_CLAMP_TO_EDGE);
  }
}

/// Describes consecutive float attributes in a buffer, with these sizes.
void set_attributes(std::initializer_list<GLint> sizes, GLuint divisor) {
  GLsizei stride = 0;
  for (const GLint size : sizes) stride += size * static_cast<GLsizei>(sizeof(float));
  GLuint attribute = 0;
  std::size_t offset = 0;
  for (const GLint size : sizes) {
    // OpenGL takes an offset in a buffer as a pointer.
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    glVertexAttribPointer(attribute, size, GL_FLOAT, GL_FALSE, stride, reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(attribute, divisor);
    glEnableVertexAttribArray(attribute);
    offset += static_cast<std::size_t>(size) * sizeof(float);
    ++attribute;
  }
}

float part_of(double turns) {
  return static_cast<float>(turns - std::floor(turns));
}

}  // namespace

FlameRenderer::FlameRenderer(const pose::SurfaceSkeleton& surface, look::Quality quality)
    : surface_(&surface),
      bowl_(meshes::flame_bowl(surface)),
      bowl_solids_(bowl_.mesh),
      noise_(gl::make_noise_texture()),
      volume_(surface),
      steps_(steps_of(quality)),
      fire_program_(gl::link_program("fire", gl::shaders::kFireVert, gl::shaders::kFireFrag)),
      spark_program_(gl::link_program("spark", gl::shaders::kSparkVert, gl::shaders::kSparkFrag)),
      sheet_program_(gl::link_program("flame", gl::shaders::kFlameVert, gl::shaders::kFlameFrag)),
      glow_program_(gl::link_program("glow", gl::shaders::kGlowVert, gl::shaders::kGlowFrag)),
      embers_program_(gl::link_program("embers", gl::shaders::kEmbersVert, gl::shaders::kEmbersFrag)),
      contact_program_(gl::link_program("contact", gl::shaders::kContactVert, gl::shaders::kContactFrag)),
      shade_program_(gl::link_program("bowl shade", gl::shaders::kBowlShadeVert, gl::shaders::kBowlShadeFrag)) {
  glBindTexture(GL_TEXTURE_2D, ramp_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kRampColors, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               surface.ramp_rgba.size() == 4 * kRampColors ? surface.ramp_rgba.data() : nullptr);
  filter_linearly(GL_TEXTURE_2D);

  const meshes::Bounds bounds = meshes::bounds_of(surface);
  const glm::vec3 size_m = bounds.high_m - bounds.low_m;
  height_m_ = std::max(size_m.y, 0.01F);
  width_m_ = std::max({volume_.is_empty() ? 0.0F : 2.0F * volume_.thickest_m(), 0.02F});
  hot_middle_m_ = (bounds.low_m + bounds.high_m) / 2.0F;
  if (!volume_.is_empty()) {
    gas_.emplace(volume_);
  } else {
    points_.emplace(surface);
    sheet_.emplace(meshes::layout_of(surface));
    width_m_ = std::max(0.3F * std::max(size_m.x, size_m.z), 0.02F);
  }

  for (const auto& [name, unit] : {std::pair<const char*, GLint>{"gas_tile", 0},
                                   {"layer_rows", gl::kFlameRowsUnit},
                                   {"noise_tile", gl::kFlameNoiseUnit},
                                   {"ramp", gl::kFlameRampUnit}}) {
    gl::set_sampler(fire_program_, name, unit);
    gl::set_sampler(embers_program_, name, unit);
    gl::set_sampler(sheet_program_, name, unit);
  }
  glUseProgram(fire_program_.name());
  glUniform1i(glGetUniformLocation(fire_program_.name(), "steps"), steps_);
  glUniform2f(glGetUniformLocation(fire_program_.name(), "size_m"), 0.5F * width_m_, height_m_);
  const float floor_m = bowl_.embers_m.y;
  glUniform2f(glGetUniformLocation(fire_program_.name(), "floor_m"), floor_m - 0.06F * width_m_,
              floor_m + 0.20F * width_m_);
  glUniform1f(glGetUniformLocation(fire_program_.name(), "reach"), meshes::FlameVolume::kReach);
  risen_place_ = glGetUniformLocation(fire_program_.name(), "risen");
  fire_brightness_place_ = glGetUniformLocation(fire_program_.name(), "brightness");
  fire_by_day_place_ = glGetUniformLocation(fire_program_.name(), "by_day");
  spark_brightness_place_ = glGetUniformLocation(spark_program_.name(), "brightness");
  glUseProgram(sheet_program_.name());
  glUniform1i(glGetUniformLocation(sheet_program_.name(), "columns"), static_cast<GLint>(surface.columns));
  glUniform1i(glGetUniformLocation(sheet_program_.name(), "rows"), static_cast<GLint>(surface.rows));
  sheet_brightness_place_ = glGetUniformLocation(sheet_program_.name(), "brightness");
  glow_ball_place_ = glGetUniformLocation(glow_program_.name(), "ball_m");
  glow_light_place_ = glGetUniformLocation(glow_program_.name(), "light");
  glUseProgram(embers_program_.name());
  glUniform4f(glGetUniformLocation(embers_program_.name(), "disc_m"), bowl_.embers_m.x, bowl_.embers_m.y,
              bowl_.embers_m.z, bowl_.embers_radius_m);
  shade_place_ = glGetUniformLocation(shade_program_.name(), "shade_m");
  embers_brightness_place_ = glGetUniformLocation(embers_program_.name(), "brightness");
  embers_breath_place_ = glGetUniformLocation(embers_program_.name(), "breath");

  glBindTexture(GL_TEXTURE_3D, gas_tile_.name());
  filter_linearly(GL_TEXTURE_3D);
  glBindTexture(GL_TEXTURE_2D, layer_rows_.name());
  filter_linearly(GL_TEXTURE_2D);

  glBindVertexArray(hull_array_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, hull_indices_.name());
  const auto indices = volume_.hull_indices();
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size_bytes()), indices.data(), GL_STATIC_DRAW);
  gl::stream_to(GL_ARRAY_BUFFER, hull_buffer_, volume_.hull());
  set_attributes({3, 3}, 0);
  glBindVertexArray(spark_array_.name());
  gl::stream_to(GL_ARRAY_BUFFER, spark_buffer_, sparks_.all());
  set_attributes({4, 4}, 1);
}

void FlameRenderer::move_to(const pose::Pose& pose) {
  const auto& burning = *std::get_if<pose::SurfacePose>(&pose);
  if (volume_.is_empty()) {
    move_sheet(burning);
  } else {
    const double passed_s = std::abs(moment_.time_s - moved_at_s_);
    if (passed_s == 0.0 && burning.heat == streamed_heat_) return;  // the same picture again
    // Another moment at the same time belongs to another stream, or a test: it is shown at once.
    const double share = passed_s > 0.0 && passed_s < kJump_s ? 1.0 - std::exp(-passed_s / kFollowing_s) : 1.0;
    volume_.move_to(*surface_, burning, static_cast<float>(share));
    moved_at_s_ = moment_.time_s;
    const auto wind_m_s = static_cast<double>(glm::length(moment_.wind_m_s));
    if (passed_s > 0.0) {
      gas_->advance_to(moment_.time_s, wind_m_s, volume_);
    } else {
      gas_->settle_at(moment_.time_s, wind_m_s, volume_);
    }
    streamed_heat_.assign(burning.heat.begin(), burning.heat.end());
    volume_.wrap(gas_->extents());
    sparks_.move_to(moment_.time_s, moment_.wind_m_s, volume_);
    heat_ = volume_.mean_heat();
    hot_middle_m_ = volume_.hot_middle_m();

    const auto layers = static_cast<GLsizei>(volume_.layer_rows().size());
    constexpr auto across = static_cast<GLsizei>(meshes::FlameGas::kAcross);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glBindTexture(GL_TEXTURE_3D, gas_tile_.name());
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RG8, across, across, GLsizei{meshes::FlameGas::kLayers}, 0, GL_RG,
                 GL_UNSIGNED_BYTE, gas_->texels().data());
    gl::count_upload(gas_->texels().size_bytes());
    glBindTexture(GL_TEXTURE_2D, layer_rows_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, 2, layers, 0, GL_RGBA, GL_FLOAT, volume_.layer_rows().data());
    gl::count_upload(volume_.layer_rows().size_bytes());
    gl::stream_to(GL_ARRAY_BUFFER, hull_buffer_, volume_.hull());
    gl::stream_to(GL_ARRAY_BUFFER, spark_buffer_, sparks_.all());
  }
  shown_heat_ = flicker_.follow(heat_, moment_.time_s);
}

void FlameRenderer::move_sheet(const pose::SurfacePose& burning) {
  const pose::SurfaceKinematicsJob job{.skeleton = surface_, .pose = &burning, .points = &*points_};
  if (job.run() != pose::SurfaceKinematicsJob::Problem::kNone || burning.heat.size() != points_->size()) return;
  sheet_->move_to(std::as_const(*points_).data());
  sheet_->set_level(burning.heat);
  float heat = 0.0F;
  glm::vec3 sum_m(0.0F);
  for (std::size_t i = 0; i < points_->size(); ++i) {
    const pose::JointPosition at = points_->point(i);
    heat += burning.heat[i];
    sum_m += burning.heat[i] * glm::vec3(at.x_m, at.y_m, at.z_m);
  }
  heat_ = heat / static_cast<float>(std::max<std::size_t>(1, burning.heat.size()));
  if (heat > 0.0F) hot_middle_m_ = sum_m / heat;
}

std::optional<light::Fire> FlameRenderer::fire() const {
  const float area_m2 = width_m_ * height_m_;
  return light::Fire{.place_m = hot_middle_m_,
                     .radius_m = 0.8F * width_m_,
                     .light = kFireLight * (moment_.flame_brightness * area_m2 * shown_heat_ / kUsualHeat)};
}

meshes::Bounds FlameRenderer::bounds_with_holder(const meshes::Bounds& bounds) const {
  meshes::Bounds with_legs = bounds;
  with_legs.low_m.y = std::min(with_legs.low_m.y, 0.0F);
  return with_legs;
}

void FlameRenderer::draw(const meshes::View&) {
  bowl_solids_.draw();
}

void FlameRenderer::draw_light() {
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  glBlendFunc(GL_DST_COLOR, GL_ZERO);
  draw_contact();
  draw_bowl_shade();
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_COLOR);
  glActiveTexture(GL_TEXTURE0 + gl::kFlameRampUnit);
  glBindTexture(GL_TEXTURE_2D, ramp_.name());
  glActiveTexture(GL_TEXTURE0 + gl::kFlameNoiseUnit);
  glBindTexture(GL_TEXTURE_2D, noise_.name());
  draw_glow();
  draw_embers();
  if (sheet_) {
    glUseProgram(sheet_program_.name());
    glUniform1f(sheet_brightness_place_, kSheetBrightness * moment_.flame_brightness);
    sheet_->draw();
  } else {
    draw_body();
    draw_sparks();
  }
  glActiveTexture(GL_TEXTURE0);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void FlameRenderer::draw_contact() {
  constexpr float kPartOfReach = 0.30F;  // the shade's reach in radii: of a bowl, as a part of that of a trunk
  glEnable(GL_POLYGON_OFFSET_FILL);      // in front of the ground
  glPolygonOffset(-2.0F, -2.0F);
  glUseProgram(contact_program_.name());
  glBindVertexArray(no_attributes_.name());
  glVertexAttrib4f(0, bowl_.embers_m.x, 0.0F, bowl_.embers_m.z, kPartOfReach * bowl_.embers_radius_m);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void FlameRenderer::draw_bowl_shade() {
  // The shadow's edge on the ground, away from the middle of the heat; the flame's top throws it nearer, its foot
  // farther.
  const glm::vec3 bowl_m = bowl_.embers_m;
  const float above_m = hot_middle_m_.y - bowl_m.y;
  if (!(bowl_m.y > 0.05F && above_m > 0.05F)) return;
  const float drawn_out = bowl_m.y / above_m;
  const float radius_m = 1.15F * bowl_.embers_radius_m;
  constexpr float kMaxDrawnOut = 3.0F;
  const glm::vec2 aside_m =
      std::min(drawn_out, kMaxDrawnOut) * glm::vec2(bowl_m.x - hot_middle_m_.x, bowl_m.z - hot_middle_m_.z);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(-2.0F, -2.0F);
  glUseProgram(shade_program_.name());
  glUniform4f(shade_place_, bowl_m.x + aside_m.x, bowl_m.z + aside_m.y,
              radius_m * (0.6F + 0.3F * std::min(drawn_out, kMaxDrawnOut)),
              radius_m * (1.3F + 1.4F * std::min(drawn_out, kMaxDrawnOut)));
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void FlameRenderer::draw_glow() {
  glUseProgram(glow_program_.name());
  const glm::vec3 light = kGlow * (moment_.flame_brightness * shown_heat_ / kUsualHeat);
  glUniform3f(glow_light_place_, light.r, light.g, light.b);
  glUniform4f(glow_ball_place_, hot_middle_m_.x, hot_middle_m_.y, hot_middle_m_.z, kGlowPerHeight * height_m_);
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void FlameRenderer::draw_embers() {
  constexpr double kBreath_s = 5.0;
  glUseProgram(embers_program_.name());
  glUniform1f(embers_brightness_place_,
              kEmbersBrightness * moment_.flame_brightness * std::min(shown_heat_ / kUsualHeat, 1.0F));
  glUniform1f(embers_breath_place_, part_of(moment_.time_s / kBreath_s));
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void FlameRenderer::draw_body() {
  glUseProgram(fire_program_.name());
  glUniform1f(risen_place_, static_cast<float>(gas_->risen()));
  const float by_day = day_of(moment_.flame_brightness);
  glUniform1f(fire_by_day_place_, by_day);
  glUniform1f(fire_brightness_place_,
              kBodyBrightness * moment_.flame_brightness * glm::mix(1.0F, kDayBrightness, by_day));
  glActiveTexture(GL_TEXTURE0 + gl::kFlameRowsUnit);
  glBindTexture(GL_TEXTURE_2D, layer_rows_.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_3D, gas_tile_.name());
  glBindVertexArray(hull_array_.name());
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(volume_.hull_indices().size()), GL_UNSIGNED_SHORT, nullptr);
  glDisable(GL_CULL_FACE);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_COLOR);
}

void FlameRenderer::draw_sparks() {
  glUseProgram(spark_program_.name());
  glUniform1f(spark_brightness_place_, moment_.flame_brightness);
  glBindVertexArray(spark_array_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(sparks_.all().size()));
}

}  // namespace yuragi::viewer::looks
