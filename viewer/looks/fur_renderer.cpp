#include "viewer/looks/fur_renderer.hpp"

#include <cmath>

#include <glm/common.hpp>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr float kDiscPerSpacing = 1.5F;  // so that discs overlap although roots are unevenly spread
constexpr GLsizei kDiscCorners = 6;

/// Sets a program's uniforms of the body: the ellipsoid in the box around the roots.
void set_body(const gl::GlProgram& program, const pose::StrandSkeleton& strands) {
  meshes::Bounds roots{glm::vec3(1e9F), glm::vec3(-1e9F)};
  for (std::size_t i = 0; i < strands.strand_count; ++i) {
    const glm::vec3 root(strands.root_x_m[i], strands.root_y_m[i], strands.root_z_m[i]);
    roots = united(roots, {root, root});
  }
  const glm::vec3 middle = (roots.low_m + roots.high_m) / 2.0F;
  const glm::vec3 radius = glm::max((roots.high_m - roots.low_m) / 2.0F, glm::vec3(0.01F));
  glUseProgram(program.name());
  glUniform3f(glGetUniformLocation(program.name(), "body_middle_m"), middle.x, middle.y, middle.z);
  glUniform3f(glGetUniformLocation(program.name(), "body_radius_m"), radius.x, radius.y, radius.z);

  // The roots cover about the upper half of the ellipsoid.
  const float area_m2 = 2.0F * (radius.x * radius.y + radius.y * radius.z + radius.z * radius.x);
  const auto count = static_cast<float>(std::max<std::size_t>(1, strands.strand_count));
  glUniform1f(glGetUniformLocation(program.name(), "disc_m"), kDiscPerSpacing * std::sqrt(area_m2 / count));
}

}  // namespace

FurRenderer::FurRenderer(const pose::StrandSkeleton& strands)
    : ribbons_(strands),
      hair_(gl::link_program("hair", gl::shaders::kHairVert, gl::shaders::kShadeFrag)),
      undercoat_(gl::link_program("undercoat", gl::shaders::kUndercoatVert, gl::shaders::kShadeFrag)) {
  gl::set_sampler(hair_, "joints", 0);
  set_body(hair_, strands);
  set_body(undercoat_, strands);
}

void FurRenderer::move_to(const pose::Pose& pose) {
  if (const auto* const bends = std::get_if<pose::StrandPose>(&pose)) ribbons_.move_to(*bends);
}

void FurRenderer::draw(const meshes::View& view) {
  ribbons_.draw(hair_, view);
  ribbons_.draw_fans(undercoat_, kDiscCorners);
}

}  // namespace yuragi::viewer::looks
