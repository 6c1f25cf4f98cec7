#pragma once

#include <array>
#include <string_view>

#include "engine/scenes/tree_model.hpp"

namespace yuragi::scenes {

/// The common properties of trees of a species: their growth, and their response to the wind (Chiba, section 3.3).
struct TreeSpecies {
  std::string_view name;
  std::array<double, 3> sway_deg;  ///< how far trunk, limbs and twigs bend in a wind of force 1 (streamlined_drag)
  double beta_horizontal;          ///< of the paper's phi (TiltJob)
  double thinness_power;           ///< p: among branches of a kind, thinner ones sway more, by (thickness)^-p
  double petiole;                  ///< how far its leaves give way, against the softest
  double flutter;                  ///< how far they flutter in a strong wind, against the liveliest
  double flutter_speed_m_s;        ///< the wind in which they flutter by 0.63 of that
  TreeHabit habit;
};

inline constexpr std::array<std::string_view, 3> kTreeSpeciesNames = {"cherry", "zelkova", "poplar"};

/// One of kTreeSpeciesNames; the last for any other name. Thread-safe: yes.
const TreeSpecies& tree_species(std::string_view name) noexcept;

}  // namespace yuragi::scenes
