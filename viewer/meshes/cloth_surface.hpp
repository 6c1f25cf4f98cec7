#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "viewer/meshes/cloth_measure.hpp"
#include "viewer/meshes/grid_mesh.hpp"

namespace yuragi::viewer::meshes {

/// The smooth surface of a cloth through its streamed joints, at as many points as a picture needs, and the rim that
/// is its thickness. A Catmull-Rom spline along the rows and one along the columns (Catmull, Rom 1974, "A class of
/// local interpolating splines"): it passes through every joint, and is a plane if the joints are evenly spaced on one.
///
/// Allocates when it is made, never afterwards. Thread-safe: no.
class ClothSurface {
 public:
  static constexpr int kCoarsest = -4;  ///< a sixteenth of the joints along each side, but at least five
  static constexpr int kFinest = 2;     ///< four times as many
  static constexpr std::size_t kMaxPoints = std::size_t{1} << 18;

  /// For joints in this layout. Has 2 to the power of `level` cells for each cell of theirs along a row, of `level` and
  /// `finer_down` along a column, but at most kMaxPoints points in total.
  ClothSurface(const GridLayout& joints, int level, int finer_down = 0);

  /// `joints`: all x, then all y, then all z.
  void move_to(std::span<const float> joints);

  /// The layout of the points, without padding.
  const GridLayout& layout() const { return layout_; }
  /// All x, then all y, then all z, like the next.
  std::span<const float> points() const { return points_; }
  std::span<const float> normals() const { return normals_; }
  /// Writes the curvature of the cloth at each point, measured over `reach_m` (of the cloth, in both directions): above
  /// 0 it is hollow on the side of its normal; in 1/m.
  void write_bends(float reach_m, const ClothMeasure& lies, std::span<float> bends_per_m) const;

  /// Each point's place on the cloth, metres: all x (to the right), then all y (down).
  std::vector<float> places_m(const ClothMeasure& lies) const;

  /// The points around the free and the fixed edges, in order, back to the first.
  std::span<const std::size_t> rim() const { return rim_; }
  /// Writes two points for each of rim(), half a thickness on either side of the cloth, and their normals, which point
  /// outward to that side: all x, then all y, then all z.
  void write_rim(float half_thickness_m, std::span<float> points, std::span<float> normals) const;

 private:
  /// The weights of a point: four joints in a row, and the share of each.
  struct Taps {
    std::size_t at[4];
    float weight[4];
  };
  static std::vector<Taps> taps(std::size_t joints, std::size_t points);

  GridLayout joints_, layout_;
  std::vector<Taps> across_, down_;
  std::vector<float> row_;  ///< a row of points, at the joints' columns: x, y, z
  std::vector<float> points_, normals_;
  std::vector<std::size_t> rim_;
};

}  // namespace yuragi::viewer::meshes
