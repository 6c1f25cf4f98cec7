#include "engine/scenes/tree_species.hpp"

#include <algorithm>

namespace yuragi::scenes {
namespace {

// Leaves are larger than in nature, where a tree has twenty times as many.
constexpr std::array kSpecies = {
    // Spreading and domed.
    TreeSpecies{.name = "cherry",
                .sway_deg = {0.9, 3.3, 8.9},
                .beta_horizontal = 0.1,
                .thinness_power = 0.7,
                .petiole = 0.8,
                .flutter = 0.5,
                .flutter_speed_m_s = 5.0,
                .habit = {.height_m = 8.0,
                          .trunk_share = 0.30,
                          .limb = {.first_at = 0.55,
                                   .angle_deg = {78, 6},
                                   .length_share = {0.62, 0.52},
                                   .lift_deg = 20,
                                   .minor_share = 0.88},
                          .twig = {.first_at = 0.2,
                                   .angle_deg = {58, 34},
                                   .length_share = {0.23, 0.18},
                                   .lift_deg = -12,
                                   .minor_share = 0.7},
                          .leaf_angle_deg = 52,
                          .leaf_length_m = 0.28,
                          .leaf_width_share = 0.5,
                          .leaf_droop_deg = 35}},
    // A vase: limbs leave the upper half of the trunk one above the other, at an open angle, and curve up.
    TreeSpecies{.name = "zelkova",
                .sway_deg = {1.05, 3.7, 9.9},
                .beta_horizontal = 0.15,
                .thinness_power = 0.8,
                .petiole = 0.9,
                .flutter = 0.57,
                .flutter_speed_m_s = 4.5,
                .habit = {.height_m = 11.0,
                          .trunk_share = 0.26,
                          .limb = {.first_at = 0.7,
                                   .angle_deg = {52, 6},
                                   .length_share = {0.66, 0.64},
                                   .lift_deg = 14,
                                   .minor_share = 0.88},
                          .twig = {.first_at = 0.25,
                                   .angle_deg = {40, 26},
                                   .length_share = {0.19, 0.16},
                                   .lift_deg = 6,
                                   .minor_share = 0.75},
                          .leaf_angle_deg = 45,
                          .leaf_length_m = 0.28,
                          .leaf_width_share = 0.4,
                          .leaf_droop_deg = 20}},
    // A narrow column.
    TreeSpecies{.name = "poplar",
                .sway_deg = {1.4, 3.0, 9.2},
                .beta_horizontal = 0.1,
                .thinness_power = 0.6,
                .petiole = 1.0,
                .flutter = 1.0,
                .flutter_speed_m_s = 1.8,
                .habit = {.height_m = 15.0,
                          .trunk_share = 0.93,
                          .limb = {.first_at = 0.07,
                                   .angle_deg = {22, 13},
                                   .length_share = {0.36, 0.13},
                                   .lift_deg = 20,
                                   .minor_share = 0.9},
                          .twig = {.first_at = 0.1,
                                   .angle_deg = {44, 24},
                                   .length_share = {0.10, 0.07},
                                   .lift_deg = 28,
                                   .minor_share = 0.85},
                          .leaf_angle_deg = 55,
                          .leaf_length_m = 0.26,
                          .leaf_width_share = 0.75,
                          .leaf_droop_deg = 30}},
};

}  // namespace

const TreeSpecies& tree_species(std::string_view name) noexcept {
  return *std::find_if(kSpecies.begin(), kSpecies.end() - 1,
                       [name](const TreeSpecies& species) { return species.name == name; });
}

}  // namespace yuragi::scenes
