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
  glm::vec3 tint{0.0F};   ///< linear light
  glm::vec3 grain{0.0F};  ///< place along and across the grain, metres; how much of a grain it has, 0 to 1
};

/// A rigid mesh of poles, rods, knobs and rims, built piece by piece. Pure.
class SolidMesh {
 public:
  /// Pieces added from now on have this amount of wood grain along their longer side: 0 to 1.
  void set_grain(float share) { grain_ = share; }

  /// A round, tapering tube from `from` to `to`, open at its ends.
  void add_tube(const glm::vec3& from, const glm::vec3& to, float from_radius_m, float to_radius_m,
                const glm::vec3& tint);
  void add_ball(const glm::vec3& middle, float radius_m, const glm::vec3& tint);
  /// Around `middle`, across `axis`: of so thick a wire. Its triangles are many, and in rings().
  void add_ring(const glm::vec3& middle, const glm::vec3& axis, float radius_m, float wire_radius_m,
                const glm::vec3& tint);
  /// A bar along `from`..`to` (level), from low_y to high_y.
  void add_beam(const glm::vec3& from, const glm::vec3& to, float half_width_m, float low_y_m, float high_y_m,
                const glm::vec3& tint);
  /// A flat piece with four corners, in their order around it.
  void add_quad(const std::array<glm::vec3, 4>& corners, const glm::vec3& tint);

  const std::vector<SolidVertex>& vertices() const { return vertices_; }
  /// Of all pieces except the rings.
  const std::vector<std::uint32_t>& indices() const { return indices_; }
  const std::vector<std::uint32_t>& rings() const { return rings_; }
  /// The radius of the thickest ring's wire; 0 if there is no ring.
  float wire_radius_m() const { return wire_radius_m_; }

 private:
  float grain_ = 0.0F;
  std::vector<SolidVertex> vertices_;
  std::vector<std::uint32_t> indices_, rings_;
  float wire_radius_m_ = 0.0F;
};

}  // namespace yuragi::viewer::meshes
