#include "engine/wind/field/wind_field.hpp"

namespace yuragi::wind::field {

WindPlace Grid::place(std::size_t i, std::size_t j, std::size_t k) const noexcept {
  const auto steps = [](std::size_t index, std::size_t middle) {
    return static_cast<double>(index) - static_cast<double>(middle);
  };
  return {spacing_m * steps(i, count_x / 2), spacing_m * steps(j, 0), spacing_m * steps(k, count_z / 2)};
}

void sample_field(const WindField& field, const Grid& grid, std::span<float> out) noexcept {
  const std::size_t size = grid.size();
  std::size_t next = 0;
  for (std::size_t k = 0; k < grid.count_z; ++k) {
    for (std::size_t j = 0; j < grid.count_y; ++j) {
      for (std::size_t i = 0; i < grid.count_x; ++i) {
        const WindVector3 wind = field.at(grid.place(i, j, k));
        out[next] = static_cast<float>(wind.u_m_s);
        out[size + next] = static_cast<float>(wind.v_m_s);
        if (field.dims() == 3) out[2 * size + next] = static_cast<float>(wind.w_m_s);
        ++next;
      }
    }
  }
}

}  // namespace yuragi::wind::field
