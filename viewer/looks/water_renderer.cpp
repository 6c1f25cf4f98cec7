#include "viewer/looks/water_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "viewer/gl/ripple_texture.hpp"
#include "viewer/gl/shaders.hpp"
#include "viewer/looks/ground_maps.hpp"
#include "viewer/meshes/grid_mesh.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr GLsizei kLowBedTexels = 512;  // a side
constexpr GLsizei kBedTexels = 1024;

// Behind the units of the shadows and of the mirror.
constexpr float kCell_px = 20.0F;  // maximum cell size of the water's mesh
/// If the processor draws, triangles of a few pixels cost more than their detail is worth.
constexpr float kLowCell_px = 120.0F;
constexpr float kKeep = 1.15F;  // a level of detail is kept this far beyond its bounds
constexpr GLint kReedRings = 6;
constexpr GLint kMirroredReedRings = 3;
constexpr float kUnderBank_m = 0.15F;        // the sheet extends this far under the bank, which hides it
constexpr std::size_t kMaxMemoryCells = 48;  // along a side

/// Slopes between which a wave begins to break and breaks completely, chosen by eye within the slopes of steep waves
/// (the limit of a regular wave is 0.58, tan 30 degrees: G. Stokes 1880).
constexpr float kBreakingFrom = 0.38F;
constexpr float kBreakingAll = 0.56F;

void describe(GLuint attribute, GLint numbers, GLsizei stride, std::size_t offset) {
  // OpenGL takes an offset in a buffer as a pointer.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  glVertexAttribPointer(attribute, numbers, GL_FLOAT, GL_FALSE, stride, reinterpret_cast<const void*>(offset));
  glEnableVertexAttribArray(attribute);
}

template <class T>
void fill(GLenum target, const gl::Buffer& buffer, const std::vector<T>& content) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(content.size() * sizeof(T)), content.data(), GL_STATIC_DRAW);
}

}  // namespace

WaterRenderer::WaterRenderer(const pose::SurfaceSkeleton& surface, look::Quality quality)
    : surface_(&surface),
      shore_(surface),
      points_(surface),
      waves_(surface, shore_),
      water_(quality == look::Quality::kLow
                 ? gl::link_program("plain water", gl::shaders::kWaterVert, gl::shaders::kPlainWaterFrag)
                 : gl::link_program("water", gl::shaders::kWaterVert, gl::shaders::kWaterFrag)),
      bed_(gl::link_program("bed", gl::shaders::kBedVert, gl::shaders::kBedFrag)),
      bank_(gl::link_program("bank", gl::shaders::kBankVert, gl::shaders::kBankFrag)),
      hole_(gl::link_program("hole", gl::shaders::kHoleVert, gl::shaders::kHoleFrag)),
      reed_(gl::link_program("reed", gl::shaders::kReedVert, gl::shaders::kShadeFrag)),
      reed_rings_place_(glGetUniformLocation(reed_.name(), "rings")),
      reed_first_corner_place_(glGetUniformLocation(reed_.name(), "first_corner")),
      mirror_share_place_(glGetUniformLocation(water_.name(), "mirror_share")),
      ripples_(gl::make_ripple_texture()),
      bed_texels_(quality == look::Quality::kLow ? kLowBedTexels : kBedTexels),
      cell_px_(quality == look::Quality::kLow ? kLowCell_px : kCell_px) {
  for (const gl::Program* program : {&water_, &bed_, &bank_, &hole_, &reed_}) GroundMaps::set_samplers(*program);
  if (!shore_.is_pond()) return;
  make_sheet();
  make_memory();
  make_shore();
}

void WaterRenderer::make_sheet() {
  // Cells that the bank hides are left out.
  const std::size_t count = surface_->columns * surface_->rows;
  std::vector<glm::vec3> rest;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec2 at_m(surface_->rest_x_m[i], surface_->rest_z_m[i]);
    rest.emplace_back(at_m, shore_.bed_m(at_m));
  }
  const auto is_hidden = [&](std::uint32_t i) {
    return shore_.out_m(glm::vec2(rest[i])) > kUnderBank_m * shore_.scale();
  };
  fill(GL_ARRAY_BUFFER, rest_buffer_, rest);
  for (std::size_t level = 0; level < kSteps.size(); ++level) {
    std::vector<std::uint32_t> triangles;
    const std::vector<std::uint32_t> all = meshes::grid_triangles(meshes::layout_of(*surface_), kSteps.at(level));
    for (std::size_t i = 0; i < all.size(); i += 3) {
      if (is_hidden(all[i]) && is_hidden(all[i + 1]) && is_hidden(all[i + 2])) continue;
      triangles.insert(triangles.end(), {all[i], all[i + 1], all[i + 2]});
    }
    Sheet& sheet = sheets_.at(level);
    sheet.index_count = static_cast<GLsizei>(triangles.size());
    glBindVertexArray(sheet.array.name());
    fill(GL_ELEMENT_ARRAY_BUFFER, sheet.indices, triangles);
    glBindBuffer(GL_ARRAY_BUFFER, rest_buffer_.name());
    describe(0, 3, sizeof(glm::vec3), 0);
    glBindBuffer(GL_ARRAY_BUFFER, height_buffer_.name());
    describe(1, 1, sizeof(float), 0);
  }

  glBindTexture(GL_TEXTURE_2D, slopes_.name());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl::set_sampler(water_, "slopes", gl::kSlopesUnit);
  gl::set_sampler(water_, "ripples", gl::kRipplesUnit);
  gl::set_sampler(water_, "mirror", gl::kMirrorUnit);
  // A point of the grid is at the centre of its texel.
  const glm::vec2 cells(static_cast<float>(surface_->columns - 1), static_cast<float>(surface_->rows - 1));
  const glm::vec2 texel_m = 2.0F * shore_.half_m() / cells;
  cell_m_ = std::max(texel_m.x, texel_m.y);
  const glm::vec2 along_m = shore_.along() * texel_m.x;
  const glm::vec2 across_m = shore_.across() * texel_m.y;
  const glm::vec2 corner_m = glm::vec2(rest[0]) - 0.5F * (along_m + across_m);
  const glm::mat2 to_parts = glm::inverse(
      glm::mat2(along_m * static_cast<float>(surface_->columns), across_m * static_cast<float>(surface_->rows)));
  glUseProgram(water_.name());
  lee_place_ = glGetUniformLocation(water_.name(), "lee");
  streaks_place_ = glGetUniformLocation(water_.name(), "streaks");
  glUniform2f(glGetUniformLocation(water_.name(), "middle_m"), shore_.middle_m().x, shore_.middle_m().y);
  gl::set_sampler(water_, "bed", gl::kBedUnit);
  const glm::vec2 texels_per_m =
      static_cast<float>(bed_texels_) * glm::vec2(glm::length(to_parts[0]), glm::length(to_parts[1]));
  glUniform1f(glGetUniformLocation(water_.name(), "bed_lod"), std::log2(std::max(texels_per_m.x, texels_per_m.y)));
  for (const gl::Program* program : {&water_, &bed_}) {
    glUseProgram(program->name());
    glUniform4f(glGetUniformLocation(program->name(), "grid_place"), corner_m.x, corner_m.y,
                std::min(texel_m.x, texel_m.y), *mirror_m());
    glUniform4f(glGetUniformLocation(program->name(), "grid_axes"), to_parts[0].x, to_parts[0].y, to_parts[1].x,
                to_parts[1].y);
  }
  glUniform1f(glGetUniformLocation(bed_.name(), "texel_m"), 1.0F / std::min(texels_per_m.x, texels_per_m.y));
}

void WaterRenderer::make_memory() {
  const std::size_t columns = std::min(surface_->columns, kMaxMemoryCells);
  const std::size_t rows = std::min(surface_->rows, kMaxMemoryCells);
  // Each cell gets an equal part of the texels of the slopes.
  const glm::vec2 points(static_cast<float>(surface_->columns), static_cast<float>(surface_->rows));
  const glm::vec2 side_m = 2.0F * shore_.half_m() * points / (points - 1.0F);
  const glm::vec2 along_m = shore_.along() * (side_m.x / static_cast<float>(columns));
  const glm::vec2 across_m = shore_.across() * (side_m.y / static_cast<float>(rows));
  memory_ = WaterMemory(columns, rows, along_m, across_m);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const glm::vec2 from_middle = glm::vec2(static_cast<float>(column), static_cast<float>(row)) + 0.5F -
                                    0.5F * glm::vec2(static_cast<float>(columns), static_cast<float>(rows));
      memory_m_.push_back(shore_.middle_m() + from_middle.x * along_m + from_middle.y * across_m);
    }
  }
  points_per_cell_.assign(columns * rows, 0.0F);
  for (std::size_t row = 0; row < surface_->rows; ++row) {
    for (std::size_t column = 0; column < surface_->columns; ++column) {
      cell_of_.push_back(row * rows / surface_->rows * columns + column * columns / surface_->columns);
      points_per_cell_[cell_of_.back()] += 1.0F;
    }
  }
  gusts_.assign(columns * rows, 0.0F);
  breaking_.assign(columns * rows, 0.0F);
  glBindTexture(GL_TEXTURE_2D, memory_texture_.name());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl::set_sampler(water_, "memory", gl::kWaterMemoryUnit);
}

void WaterRenderer::make_shore() {
  const meshes::BankMesh mesh = meshes::bank_of(shore_);
  hole_count_ = static_cast<GLsizei>(mesh.hole.size());
  bank_count_ = static_cast<GLsizei>(mesh.bank.size());
  fill(GL_ARRAY_BUFFER, bank_buffer_, mesh.vertices);
  for (const bool is_hole : {true, false}) {
    glBindVertexArray(is_hole ? hole_array_.name() : bank_array_.name());
    fill(GL_ELEMENT_ARRAY_BUFFER, is_hole ? hole_indices_ : bank_indices_, is_hole ? mesh.hole : mesh.bank);
    glBindBuffer(GL_ARRAY_BUFFER, bank_buffer_.name());
    describe(0, 3, sizeof(meshes::BankVertex), offsetof(meshes::BankVertex, place_m));
    describe(1, 3, sizeof(meshes::BankVertex), offsetof(meshes::BankVertex, normal));
    describe(2, 1, sizeof(meshes::BankVertex), offsetof(meshes::BankVertex, edge));
  }
  glUseProgram(bank_.name());
  glUniform1f(glGetUniformLocation(bank_.name(), "water_m"), *mirror_m());

  const std::vector<meshes::Reed> reeds = meshes::reeds_of(shore_);
  reed_count_ = reeds.size();
  reeds_.fill(std::span(reeds));
  gl::set_sampler(reed_, "reeds", gl::kStripsUnit);
}

std::optional<float> WaterRenderer::mirror_m() const {
  if (!shore_.is_pond()) return std::nullopt;
  return surface_->rest_y_m[0] - meshes::Shore::kSunk_m;
}

void WaterRenderer::set_moment(const Moment& moment) {
  moment_ = moment;
}

void WaterRenderer::move_to(const pose::Pose& pose) {
  const auto* const waves = std::get_if<pose::SurfacePose>(&pose);
  const pose::SurfaceKinematicsJob job{.skeleton = surface_, .pose = waves, .points = &points_};
  if (!shore_.is_pond() || job.run() != pose::SurfaceKinematicsJob::Problem::kNone) return;
  const std::size_t count = surface_->columns * surface_->rows;
  waves_.move_to(std::as_const(points_).data().data() + count);  // all x, then all y
  gl::stream_to(GL_ARRAY_BUFFER, height_buffer_, std::span<const float>(waves_.heights_m()));
  glActiveTexture(GL_TEXTURE0 + gl::kSlopesUnit);
  glBindTexture(GL_TEXTURE_2D, slopes_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, static_cast<GLsizei>(surface_->columns),
               static_cast<GLsizei>(surface_->rows), 0, GL_RGBA, GL_FLOAT, waves_.slopes().data());
  gl::count_upload(waves_.slopes().size() * sizeof(float));
  glGenerateMipmap(GL_TEXTURE_2D);
  glActiveTexture(GL_TEXTURE0);
}

/// Draws the map of the bed, which is constant.
void WaterRenderer::draw_bed() {
  constexpr std::array<float, 4> kEarth{0.32F, 0.28F, 0.22F, 1.0F};  // under the bank
  glBindTexture(GL_TEXTURE_2D, bed_texture_.name());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, bed_texels_, bed_texels_, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  const gl::Framebuffer canvas;
  glBindFramebuffer(GL_FRAMEBUFFER, canvas.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, bed_texture_.name(), 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("the graphics driver cannot draw the bed of a pond");
  }
  glViewport(0, 0, bed_texels_, bed_texels_);
  glDisable(GL_DEPTH_TEST);
  glClearBufferfv(GL_COLOR, 0, kEarth.data());
  glUseProgram(bed_.name());
  glBindVertexArray(sheets_[0].array.name());
  glDrawElements(GL_TRIANGLES, sheets_[0].index_count, GL_UNSIGNED_INT, nullptr);
  glEnable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glBindTexture(GL_TEXTURE_2D, bed_texture_.name());
  glGenerateMipmap(GL_TEXTURE_2D);
  has_bed_ = true;
}

/// Computes the share of each of the memory's cells where waves break.
void WaterRenderer::sum_up_breaking() {
  std::ranges::fill(breaking_, 0.0F);
  constexpr float kFrom = kBreakingFrom * kBreakingFrom;
  constexpr float kAll = kBreakingAll * kBreakingAll;
  const std::vector<float>& slopes = waves_.slopes();
  for (std::size_t i = 0; i < cell_of_.size(); ++i) {
    if (slopes[4 * i + 2] > kFrom)
      breaking_[cell_of_[i]] += std::min((slopes[4 * i + 2] - kFrom) / (kAll - kFrom), 1.0F);
  }
  for (std::size_t i = 0; i < breaking_.size(); ++i) breaking_[i] /= points_per_cell_[i];
}

void WaterRenderer::feel_ground(const GroundMaps& ground) {
  // A gust that bends grass this much farther than the mean wind, radians, roughens the water completely.
  constexpr float kGustAtRest_rad = 0.03F;
  constexpr float kGustPart = 0.15F;
  constexpr float kMaxCalmed = 0.8F;
  // Foam reaches the lee shore from Beaufort 5 on: floating foam is driven by breaking waves.
  constexpr float kFoamFrom_m_s = 6.0F;
  constexpr float kFoamFull_m_s = 13.0F;
  if (!shore_.is_pond()) return;
  if (!has_bed_) draw_bed();
  const float mean_rad = glm::length(ground.mean_bend());
  for (std::size_t i = 0; i < gusts_.size(); ++i) {
    const float more_rad = glm::length(ground.bend_at(memory_m_[i])) - mean_rad;
    gusts_[i] = std::clamp(more_rad / (kGustAtRest_rad + kGustPart * mean_rad), -kMaxCalmed, 1.0F);
  }
  sum_up_breaking();
  memory_.advance_to(moment_.time_s, {.wind_m_s = moment_.wind_m_s, .gusts = gusts_, .breaking = breaking_});

  glActiveTexture(GL_TEXTURE0 + gl::kWaterMemoryUnit);
  glBindTexture(GL_TEXTURE_2D, memory_texture_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG16F, static_cast<GLsizei>(memory_.columns()),
               static_cast<GLsizei>(memory_.rows()), 0, GL_RG, GL_FLOAT, memory_.cells().data());
  gl::count_upload(memory_.cells().size_bytes());
  glActiveTexture(GL_TEXTURE0);

  const glm::vec2 wind_m_s = memory_.shaping_wind_m_s();
  const float speed_m_s = glm::length(wind_m_s);
  const glm::vec2 downwind = speed_m_s > 0.0F ? wind_m_s / speed_m_s : glm::vec2(1.0F, 0.0F);
  const glm::vec2 half_m(glm::dot(downwind, shore_.along()) * shore_.half_m().x,
                         glm::dot(downwind, shore_.across()) * shore_.half_m().y);
  const glm::vec2 lee = downwind / std::max(glm::length(half_m), 0.1F);
  glUseProgram(water_.name());
  glUniform3f(lee_place_, lee.x, lee.y,
              std::clamp((speed_m_s - kFoamFrom_m_s) / (kFoamFull_m_s - kFoamFrom_m_s), 0.0F, 1.0F));
  glUniform4f(streaks_place_, downwind.x, downwind.y, memory_.drifted_m().x, memory_.drifted_m().y);
}

void WaterRenderer::draw_reeds(GLint rings) {
  glUseProgram(reed_.name());
  glUniform1i(reed_rings_place_, rings);
  reeds_.bind(gl::kStripsUnit);
  glActiveTexture(GL_TEXTURE0);
  reed_strips_.draw(reed_first_corner_place_, 2 * (static_cast<std::size_t>(rings) + 1), 0, reed_count_);
}

const WaterRenderer::Sheet& WaterRenderer::sheet_in(const meshes::View& view) {
  // From the eye to the nearest point of the water.
  const glm::vec2 off_m = glm::vec2(view.eye_m.x, view.eye_m.z) - shore_.middle_m();
  const glm::vec2 beside_m(std::abs(glm::dot(off_m, shore_.along())), std::abs(glm::dot(off_m, shore_.across())));
  const glm::vec2 out_m = glm::max(beside_m - shore_.half_m(), 0.0F);
  const float nearest_m = glm::length(glm::vec3(out_m, view.eye_m.y - *mirror_m()));
  // It is flat except for its waves, which are shaded per pixel: a cell can be wide.
  const float widest = cell_px_ * view.eye_m.w * nearest_m / cell_m_;  // step
  const float now = static_cast<float>(kSteps.at(level_));
  if (now > widest * kKeep || 2.0F * now < widest / kKeep) {
    level_ = 0;
    while (level_ + 1 < kSteps.size() && static_cast<float>(kSteps.at(level_ + 1)) <= widest) ++level_;
  }
  return sheets_.at(level_);
}

void WaterRenderer::draw(const meshes::View& view) {
  if (!shore_.is_pond()) return;
  draw_reeds(kReedRings);
  glUseProgram(bank_.name());
  glBindVertexArray(bank_array_.name());
  glDrawElements(GL_TRIANGLES, bank_count_, GL_UNSIGNED_INT, nullptr);

  glUseProgram(water_.name());
  glUniform1f(mirror_share_place_, mirror_share_);
  glActiveTexture(GL_TEXTURE0 + gl::kSlopesUnit);
  glBindTexture(GL_TEXTURE_2D, slopes_.name());
  glActiveTexture(GL_TEXTURE0 + gl::kRipplesUnit);
  glBindTexture(GL_TEXTURE_2D, ripples_.name());
  glActiveTexture(GL_TEXTURE0 + gl::kWaterMemoryUnit);
  glBindTexture(GL_TEXTURE_2D, memory_texture_.name());
  glActiveTexture(GL_TEXTURE0 + gl::kBedUnit);
  glBindTexture(GL_TEXTURE_2D, bed_texture_.name());
  glActiveTexture(GL_TEXTURE0);
  const Sheet& sheet = sheet_in(view);
  glBindVertexArray(sheet.array.name());
  glDrawElements(GL_TRIANGLES, sheet.index_count, GL_UNSIGNED_INT, nullptr);
}

void WaterRenderer::draw_mirrored(const meshes::View&) {
  if (shore_.is_pond()) draw_reeds(kMirroredReedRings);
}

void WaterRenderer::draw_hole() {
  if (!shore_.is_pond()) return;
  glUseProgram(hole_.name());
  glBindVertexArray(hole_array_.name());
  glDrawElements(GL_TRIANGLES, hole_count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace yuragi::viewer::looks
