#pragma once

#include <array>
#include <string_view>

#include "engine/scenes/tree_model.hpp"

namespace yuragi {

/// What trees of a species have in common: how they grow, and how they answer the wind (Chiba, section 3.3).
struct TreeSpecies {
  std::string_view name;
  double petiole;          ///< how far its leaves give way, against the softest
  double alpha_vertical;   ///< of the paper's theta (TiltJob)
  double beta_horizontal;  ///< of the paper's phi
  double thinness_power;   ///< p: the thinner wood sways the more, by (root thickness / thickness)^p
  TreeHabit habit;
};

inline constexpr std::array<std::string_view, 3> kTreeSpeciesNames = {"cherry", "zelkova", "poplar"};

/// One of kTreeSpeciesNames; the last for any other name. Thread-safe: yes.
const TreeSpecies& tree_species(std::string_view name) noexcept;

}  // namespace yuragi
