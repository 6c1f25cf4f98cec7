#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

namespace yuragi::viewer::looks {

/// The memory of a pond's surface: how far gusts have roughened each cell of a grid, and where foam floats. Waves rise
/// more slowly than a gust, outlive it, and travel downwind while they last. Pure: the same steps give the same state.
/// The first step, and one back in time, takes the steady state of its input.
class WaterMemory {
 public:
  static constexpr float kRise_s = 1.3F;   ///< time constant with which a gust roughens water
  static constexpr float kDecay_s = 3.0F;  ///< with which the water calms, and foam dissolves
  /// Foam appears within a breaking crest.
  static constexpr float kBreaking_s = 0.25F;

  /// The forces on the water at a moment: a number for each cell, row after row.
  struct Forces {
    glm::vec2 wind_m_s{0.0F};         ///< toward east and south
    std::span<const float> gusts;     ///< how far the wind wakes the water: -1 to 1, 0 in the mean wind
    std::span<const float> breaking;  ///< the share of the cell where waves break, 0 to 1
  };

  WaterMemory() = default;
  /// `to_next_m`, `to_next_row_m`: from a cell to the next one in its row, and to the next row; not parallel.
  WaterMemory(std::size_t columns, std::size_t rows, const glm::vec2& to_next_m, const glm::vec2& to_next_row_m);

  /// Advances to a moment. Allocates nothing. The same moment again changes nothing.
  void advance_to(double time_s, const Forces& forces);

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  /// Two numbers a cell: how far it is woken (-1 to 1), and its share of foam (0 to 1).
  std::span<const float> cells() const { return cells_; }
  /// The wind that has shaped the water: speed and direction change with kDecay_s.
  const glm::vec2& shaping_wind_m_s() const { return shaping_wind_m_s_; }
  /// How far the surface has drifted since the first step, metres.
  const glm::vec2& drifted_m() const { return drifted_m_; }

 private:
  void settle(const Forces& forces);
  void carry(const glm::vec2& by_cells);

  std::size_t columns_ = 0, rows_ = 0;
  glm::mat2 to_cells_{1.0F};  ///< converts metres to columns and rows
  bool is_settled_ = false;
  double time_s_ = 0.0;
  std::vector<float> cells_, carried_;
  glm::vec2 shaping_wind_m_s_{0.0F}, drifted_m_{0.0F};
};

}  // namespace yuragi::viewer::looks
