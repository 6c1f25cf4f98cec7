#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace yuragi::viewer::meshes {

/// A vertex of a rigid mesh, in the layout that the shader reads.
struct SolidVertex {
  glm::vec3 place_m{0.0F};
  glm::vec3 normal{0.0F};
  glm::vec3 tint{0.0F};  ///< linear light
};

/// A rigid mesh of poles, rods, knobs and rims, built piece by piece. Pure.
class SolidMesh {
 public:
  /// From `from` to `to`, round, tapering, open at its ends.
  void add_tube(const glm::vec3& from, const glm::vec3& to, float from_radius_m, float to_radius_m,
                const glm::vec3& tint);
  void add_ball(const glm::vec3& middle, float radius_m, const glm::vec3& tint);
  /// A bar with four sides along `from`..`to` (level), from low_y to high_y.
  void add_beam(const glm::vec3& from, const glm::vec3& to, float half_width_m, float low_y_m, float high_y_m,
                const glm::vec3& tint);
  /// A flat piece with four corners, in their order around it.
  void add_quad(const std::array<glm::vec3, 4>& corners, const glm::vec3& tint);

  const std::vector<SolidVertex>& vertices() const { return vertices_; }
  const std::vector<std::uint32_t>& indices() const { return indices_; }

 private:
  std::vector<SolidVertex> vertices_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace yuragi::viewer::meshes
