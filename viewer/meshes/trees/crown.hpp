#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/pose/tree_kinematics.hpp"
#include "viewer/meshes/trees/sprays.hpp"
#include "viewer/meshes/trees/tree_parts.hpp"
#include "viewer/meshes/trees/tree_place.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes::trees {

/// A spray, in the leaves' shader's layout: a parabola from root to tip.
struct SprayPlace {
  glm::vec3 root_m{0.0F};
  float length_m = 0.0F;
  glm::vec3 tip_m{0.0F};
  float leaves = 0.0F;    ///< number that is drawn; the last one in part
  glm::vec3 bow_m{0.0F};  ///< at u of the way from root to tip the spray is u (1 - u) of this beside the straight line
  float blown = 0.0F;     ///< the square of how far the wind has turned it from rest (the chord of unit vectors)
  glm::vec3 upper{0.0F};  ///< the normal of its upper side
  float size = 1.0F;      ///< size of its leaves: larger if few are drawn
  glm::vec3 tint{0.0F};   ///< linear light
  float number = 0.0F;    ///< of the spray
  glm::vec4 open{0.0F};   ///< the share of light that reaches it from a direction d: about w + dot(xyz, d)
};

/// Sprays that are drawn with one mesh.
struct SprayGroup {
  SprayKind kind = SprayKind::kFar;
  std::size_t leaves = 0;  ///< of the mesh
  std::size_t first = 0;   ///< of Crown::places()
  std::size_t count = 0;
};

/// All sprays of a level of leaves, and their selection for a picture and its detail.
///
/// Sprays are selected in groups of 16 that grow on one twig: invisible ones are omitted; distant ones, and those
/// hidden by others, get fewer, larger leaves, and then there are fewer sprays. Everything appears and disappears by
/// growing. Allocates when it is made, never afterwards.
class Crown {
 public:
  /// `tree` must outlive this. With the tree's own foliage or another one: a tree with leaves that is shown bare has
  /// stiff twigs instead, which move with the wood that bears them.
  Crown(const pose::TreeSkeleton& tree, std::size_t level);
  Crown(const pose::TreeSkeleton& tree, std::size_t level, pose::FoliageColor foliage);

  const SprayShape& shape() const { return shape_; }

  void move_to(const pose::TreeJoints& joints);

  /// The mean of SprayPlace::blown.
  float blown() const { return blown_; }

  /// Selects the visible ones of the tree, or of a copy of it.
  void choose(const View& view, const SprayDetail& detail, const Place& place = {});
  std::span<const SprayPlace> places() const { return std::span(chosen_).first(chosen_count_); }
  std::span<const SprayGroup> groups() const { return groups_; }

 private:
  struct Choice {
    SprayLevel level;
    std::size_t group = 0;
    bool is_seen = false;
  };
  struct Ball {
    glm::vec3 middle_m{0.0F};
    float radius_m = 0.0F;
    glm::vec4 open{0.0F};  // mean of its sprays
  };

  std::size_t strands_in(std::size_t block) const;
  void straighten(SprayPlace& spray, std::size_t strand, const pose::TreeJoints& joints) const;

  const pose::TreeSkeleton* tree_;
  std::size_t level_;
  SprayShape shape_;
  bool is_stiff_;  // its strands do not bend, unlike those of the stream
  float leaf_m_ = 0.0F;
  std::vector<Part> parts_;
  std::vector<SprayPlace> sprays_;
  std::vector<Ball> balls_;  // around each block of sprays
  std::vector<Choice> choices_;
  std::vector<SprayGroup> groups_;
  std::vector<SprayPlace> chosen_;
  std::size_t chosen_count_ = 0;
  float blown_ = 0.0F;
};

/// The light from all around that reaches each strand of a level of leaves through the others: see SprayPlace::open.
/// Computed from the leaves' area in the cells of a grid, in which light is lost according to M. Monsi and T. Saeki
/// 1953 ("Ueber den Lichtfaktor in den Pflanzengesellschaften", Beer's law with half of the leaf area across the
/// light), at rest.
std::vector<glm::vec4> crown_openness(const pose::TreeSkeleton& tree, std::size_t level, const SprayShape& shape);

}  // namespace yuragi::viewer::meshes::trees
