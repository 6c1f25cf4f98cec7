#include "viewer/looks/cloth_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "viewer/gl/shaders.hpp"
#include "viewer/looks/image_texture.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr float kKeep = 0.15F;  // share of a level: it is kept this far beyond its bounds
constexpr float kNearest_m = 0.1F;
constexpr std::size_t kLooks = 12;            // joints along each side whose distance is computed
constexpr float kHalfHem_m = 0.0015F;         // half the thickness of a hem
const glm::vec3 kLinen{0.70F, 0.63F, 0.51F};  // curtain.frag.glsl's
constexpr float kDarkestPaint = 0.012F;
constexpr float kLightestPaint = 0.78F;
constexpr float kShadowCell_px = 12.0F;  // of a shadow's mesh
constexpr float kThinnestWire_px = 0.8F;
constexpr float kThinnest_px = 0.2F;  // a rim below half of this is invisible

/// How wide the cells of the coarsest mesh are that does, at most, pixels.
float cell_px_of(look::Quality quality) {
  switch (quality) {
    case look::Quality::kLow:
      return 6.0F;
    case look::Quality::kMedium:
      return 4.0F;
    case look::Quality::kHigh:
    case look::Quality::kAuto:
      break;
  }
  return 3.0F;
}

/// A curtain's folds hang down: its cells are half as wide as those of another cloth, and twice as high.
constexpr float kFoldedShare = 0.5F;
constexpr int kFoldedLevels = 2;

/// How much more finely a cloth is divided along a column than along a row, as a power of 2, for well-shaped cells.
int finer_down(meshes::ClothStyle style, const meshes::ClothMeasure& lies) {
  const float across_m = glm::length(lies.per_column_m);
  const float down_m = glm::length(lies.per_row_m);
  if (!(across_m > 0.0F) || !(down_m > 0.0F)) return 0;
  const int folded = style == meshes::ClothStyle::kCurtain ? kFoldedLevels : 0;
  return static_cast<int>(std::lround(std::clamp(std::log2(down_m / across_m), -8.0F, 8.0F))) - folded;
}

/// From a banner's pole to the end of its arm, horizontally, at rest and in a pose.
glm::vec2 arm_m(const pose::GridSkeleton& cloth, const pose::GridPose* pose) {
  const std::size_t end = cloth.columns - 1;
  const glm::vec2 at_rest_m(cloth.rest_x_m[end] - cloth.rest_x_m[0], cloth.rest_z_m[end] - cloth.rest_z_m[0]);
  return pose == nullptr ? at_rest_m : at_rest_m + glm::vec2(pose->offset_x_m[end], pose->offset_z_m[end]);
}

/// A screen's value (IEC 61966-2-1, sRGB) as reflectance of cloth, which is never quite black or white.
float paint_of(std::uint8_t value) {
  const float part = static_cast<float>(value) / 255.0F;
  const float light = part <= 0.04045F ? part / 12.92F : std::pow((part + 0.055F) / 1.055F, 2.4F);
  return kDarkestPaint + (kLightestPaint - kDarkestPaint) * light;
}

/// w: 1 if there is one.
glm::vec4 paint_of(const std::optional<look::Color>& color) {
  if (!color) return glm::vec4(0.0F);
  return {paint_of(color->red), paint_of(color->green), paint_of(color->blue), 1.0F};
}

/// The share of the sun's light that passes through a curtain, on average over its picture or its stripes: the cloth's
/// colour, more saturated, as in the cloth shader.
glm::vec3 light_through(const look::ClothLook& look) {
  constexpr float kThrough = 0.62F;
  glm::vec3 paint(look.color ? glm::vec3(paint_of(look.color)) : kLinen);
  if (look.color_2) paint = 0.5F * (paint + glm::vec3(paint_of(look.color_2)));
  if (look.image != nullptr && look.image->rgb.size() >= 3) {
    paint = glm::vec3(0.0F);
    const std::size_t pixels = look.image->rgb.size() / 3;
    for (std::size_t i = 0; i < 3 * pixels; ++i) {
      paint[static_cast<glm::length_t>(i % 3)] += paint_of(look.image->rgb[i]) / static_cast<float>(pixels);
    }
  }
  return kThrough * 1.25F * paint * glm::sqrt(paint);
}

gl::Program program_of(meshes::ClothStyle style) {
  switch (style) {
    case meshes::ClothStyle::kFlag:
      return gl::link_program("flag", gl::shaders::kClothVert, gl::shaders::kFlagFrag);
    case meshes::ClothStyle::kBanner:
      return gl::link_program("banner", gl::shaders::kClothVert, gl::shaders::kBannerFrag);
    case meshes::ClothStyle::kCurtain:
      break;
  }
  return gl::link_program("curtain", gl::shaders::kClothVert, gl::shaders::kCurtainFrag);
}

/// Bounds of its vertices; `none` if there are none.
meshes::Bounds bounds_of(const meshes::SolidMesh& mesh, const meshes::Bounds& none) {
  if (mesh.vertices().empty()) return none;
  meshes::Bounds bounds{mesh.vertices()[0].place_m, mesh.vertices()[0].place_m};
  for (const meshes::SolidVertex& vertex : mesh.vertices()) {
    bounds = meshes::united(bounds, {vertex.place_m, vertex.place_m});
  }
  return bounds;
}

}  // namespace

ClothRenderer::ClothRenderer(const pose::GridSkeleton& cloth, meshes::ClothStyle style, const look::ClothLook& look,
                             look::Quality quality, const meshes::SolidMesh& holder)
    : cloth_(&cloth),
      lies_(meshes::measure(cloth)),
      style_(style),
      is_vane_(style_ == meshes::ClothStyle::kBanner && cloth.columns > 1 && cloth.rows > 0),
      points_(cloth),
      cell_px_(cell_px_of(quality) * (style == meshes::ClothStyle::kCurtain ? kFoldedShare : 1.0F)),
      finer_down_(finer_down(style, lies_)),
      is_shadow_coarse_(quality == look::Quality::kLow),
      holder_bounds_(bounds_of(holder, meshes::bounds_of(cloth))),
      holder_(holder),
      wire_m_(2.0F * holder.wire_radius_m()),
      floor_(meshes::cloth_floor(style_, cloth)),
      program_(program_of(style_)) {
  if (floor_) boards_.emplace(*floor_, light_through(look));
  glUseProgram(program_.name());
  glUniform2f(glGetUniformLocation(program_.name(), "size_m"), lies_.size_m.x, lies_.size_m.y);
  glUniform4fv(glGetUniformLocation(program_.name(), "color_1"), 1, &paint_of(look.color)[0]);
  glUniform4fv(glGetUniformLocation(program_.name(), "color_2"), 1, &paint_of(look.color_2)[0]);
  glUniform1i(glGetUniformLocation(program_.name(), "has_picture"), look.image != nullptr ? 1 : 0);
  gl::set_sampler(program_, "picture", 0);
  if (look.image != nullptr) picture_ = image_texture(*look.image, GL_CLAMP_TO_EDGE);
}

float ClothRenderer::nearest_m(const meshes::View& view) const {
  const glm::vec3 eye_m(view.eye_m);
  float nearest_m = std::numeric_limits<float>::max();
  const std::size_t row_step = std::max<std::size_t>(cloth_->rows / kLooks, 1);
  const std::size_t column_step = std::max<std::size_t>(cloth_->columns / kLooks, 1);
  for (std::size_t row = 0; row < cloth_->rows; row += row_step) {
    for (std::size_t column = 0; column < cloth_->columns; column += column_step) {
      const pose::JointPosition at = points_.point(row * cloth_->stride() + column);
      nearest_m = std::min(nearest_m, glm::distance(eye_m, glm::vec3(at.x_m, at.y_m, at.z_m)));
    }
  }
  return std::max(nearest_m, kNearest_m);
}

int ClothRenderer::level_in(const meshes::View& view, float cell_px, const std::optional<int>& before) const {
  const float cell_m = std::max(glm::length(lies_.per_column_m), 1e-6F);
  const float wanted = std::clamp(std::log2(cell_m / (cell_px * view.eye_m.w * nearest_m(view))),
                                  static_cast<float>(meshes::ClothSurface::kCoarsest),
                                  static_cast<float>(meshes::ClothSurface::kFinest));
  if (before) {
    const auto last = static_cast<float>(*before);
    if (wanted > last - 1.0F - kKeep && wanted < last + kKeep) return *before;
  }
  return static_cast<int>(std::ceil(wanted));
}

ClothSheet& ClothRenderer::sheet(int level) {
  const auto i = static_cast<std::size_t>(level - meshes::ClothSurface::kCoarsest);
  std::optional<ClothSheet>& sheet = sheets_.at(i);
  if (!sheet) sheet.emplace(meshes::layout_of(*cloth_), lies_, level, finer_down_);
  if (!is_moved_.at(i)) sheet->move_to(std::as_const(points_).data());
  is_moved_.at(i) = true;
  return *sheet;
}

void ClothRenderer::move_to(const pose::Pose& pose) {
  const auto* const offsets = std::get_if<pose::GridPose>(&pose);
  const pose::GridKinematicsJob job{.skeleton = cloth_, .pose = offsets, .points = &points_};
  if (job.run() != pose::GridKinematicsJob::Problem::kNone) return;
  is_moved_.fill(false);
  if (!is_vane_) return;
  const glm::vec2 rest_m = arm_m(*cloth_, nullptr);
  const glm::vec2 now_m = arm_m(*cloth_, offsets);
  const float square_m2 = glm::length(rest_m) * glm::length(now_m);
  if (!(square_m2 > 0.0F)) return;
  holder_.turn({cloth_->rest_x_m[0], cloth_->rest_z_m[0]}, (rest_m.x * now_m.y - rest_m.y * now_m.x) / square_m2,
               glm::dot(rest_m, now_m) / square_m2);
}

void ClothRenderer::draw(const meshes::View& view) {
  level_ = level_in(view, cell_px_, level_);
  glUseProgram(program_.name());
  if (picture_) glBindTexture(GL_TEXTURE_2D, picture_->name());
  ClothSheet& now = sheet(*level_);
  now.draw();
  const float pixel_m = view.eye_m.w * nearest_m(view);
  if (kHalfHem_m > kThinnest_px * pixel_m) now.draw_rim(kHalfHem_m);
  wire_m_ > kThinnestWire_px* pixel_m ? holder_.draw() : holder_.draw_coarsely();
  if (!boards_) return;
  boards_->draw();
  if (view.shadow.x == 0.0F) boards_->draw_in_shade([&] { now.draw(); });
}

void ClothRenderer::draw_shadow(const meshes::View& view) {
  // It can be coarse with quality low. Otherwise the sun must see the mesh that the eye saw in the last picture, or the
  // cloth would shade itself.
  if (is_shadow_coarse_) {
    shadow_level_ = level_in(view, std::max(cell_px_, kShadowCell_px), shadow_level_);
  } else if (!level_) {
    level_ = level_in(view, cell_px_, level_);
  }
  glUseProgram(program_.name());
  sheet(is_shadow_coarse_ ? *shadow_level_ : *level_).draw();
  holder_.draw_coarsely();
}

}  // namespace yuragi::viewer::looks
