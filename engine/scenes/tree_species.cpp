#include "engine/scenes/tree_species.hpp"

#include <algorithm>

namespace yuragi::scenes {
namespace {

// Leaves are larger than in nature, where a tree has twenty times as many.
constexpr std::array kSpecies = {
    // A wide vase: limbs rise steeply, and arch outward under their weight.
    TreeSpecies{.name = "cherry",
                .sway_deg = {0.9, 4.0, 15.0},
                .beta_horizontal = 0.1,
                .thinness_power = 0.7,
                .petiole = 0.8,
                .flutter = 0.5,
                .flutter_speed_m_s = 5.0,
                .habit = {.height_m = 8.0,
                          .trunk_share = 0.26,
                          .limb = {.first_at = 0.6,
                                   .angle_deg = {66, 16},
                                   .length_share = {0.66, 0.64},
                                   .lift_deg = -34,
                                   .minor_share = 0.8,
                                   .whorl = 4},
                          .twig = {.first_at = 0.4,
                                   .angle_deg = {56, 40},
                                   .length_share = {0.17, 0.14},
                                   .lift_deg = -18,
                                   .minor_share = 0.7,
                                   .whorl = 4},
                          .leaf_angle_deg = 52,
                          .leaf_length_m = 0.28,
                          .leaf_width_share = 0.5,
                          .leaf_droop_deg = 35,
                          .leafless_share = 0.3}},
    // A broom: many steep limbs from one place, which spread like a fan and arch a little outward.
    TreeSpecies{.name = "zelkova",
                .sway_deg = {1.05, 4.5, 16.5},
                .beta_horizontal = 0.15,
                .thinness_power = 0.8,
                .petiole = 0.9,
                .flutter = 0.57,
                .flutter_speed_m_s = 4.5,
                .habit = {.height_m = 11.0,
                          .trunk_share = 0.24,
                          .limb = {.first_at = 0.8,
                                   .angle_deg = {28, 9},
                                   .length_share = {0.68, 0.72},
                                   .lift_deg = -34,
                                   .minor_share = 0.78,
                                   .whorl = 5},
                          .twig = {.first_at = 0.5,
                                   .angle_deg = {46, 32},
                                   .length_share = {0.15, 0.12},
                                   .lift_deg = -8,
                                   .minor_share = 0.75,
                                   .whorl = 4},
                          .leaf_angle_deg = 45,
                          .leaf_length_m = 0.28,
                          .leaf_width_share = 0.4,
                          .leaf_droop_deg = 20,
                          .leafless_share = 0.25}},
    // A narrow column: limbs leave the trunk at an open angle, and turn up beside it.
    TreeSpecies{.name = "poplar",
                .sway_deg = {1.4, 3.6, 15.0},
                .beta_horizontal = 0.1,
                .thinness_power = 0.6,
                .petiole = 1.0,
                .flutter = 1.0,
                .flutter_speed_m_s = 1.8,
                .habit = {.height_m = 15.0,
                          .trunk_share = 0.93,
                          .limb = {.first_at = 0.07,
                                   .angle_deg = {36, 18},
                                   .length_share = {0.26, 0.13},
                                   .lift_deg = 38,
                                   .minor_share = 0.8},
                          .twig = {.first_at = 0.12,
                                   .angle_deg = {44, 24},
                                   .length_share = {0.10, 0.07},
                                   .lift_deg = 28,
                                   .minor_share = 0.8},
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
