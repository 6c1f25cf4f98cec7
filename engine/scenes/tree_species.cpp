#include "engine/scenes/tree_species.hpp"

#include <algorithm>

namespace yuragi::scenes {
namespace {

// Leaves are larger than in nature, where a tree has twenty times as many.
constexpr std::array kSpecies = {
    // Spreading and domed.
    TreeSpecies{
        .name = "cherry",
        .sway_deg = {0.9, 3.3, 8.9},
        .beta_horizontal = 0.1,
        .thinness_power = 0.7,
        .petiole = 0.8,
        .flutter = 0.5,
        .flutter_speed_m_s = 5.0,
        .habit = {.height_m = 8.0,
                  .trunk_share = 0.5,
                  .limb = {.first_at = 0.4, .angle_deg = {75, 25}, .length_share = {0.55, 0.42}, .lift_deg = 25},
                  .twig = {.first_at = 0.2, .angle_deg = {60, 35}, .length_share = {0.2, 0.12}, .lift_deg = -35},
                  .leaf_angle_deg = 60,
                  .leaf_length_m = 0.19,
                  .leaf_width_share = 0.5,
                  .leaf_droop_deg = 50}},
    // A vase: limbs leave the upper half of the trunk one above the other, at an open angle, and curve up.
    TreeSpecies{
        .name = "zelkova",
        .sway_deg = {1.05, 3.7, 9.9},
        .beta_horizontal = 0.15,
        .thinness_power = 0.8,
        .petiole = 0.9,
        .flutter = 0.57,
        .flutter_speed_m_s = 4.5,
        .habit = {.height_m = 11.0,
                  .trunk_share = 0.46,
                  .limb = {.first_at = 0.4, .angle_deg = {50, 18}, .length_share = {0.64, 0.50}, .lift_deg = 24},
                  .twig = {.first_at = 0.35, .angle_deg = {45, 30}, .length_share = {0.17, 0.11}, .lift_deg = -20},
                  .leaf_angle_deg = 55,
                  .leaf_length_m = 0.19,
                  .leaf_width_share = 0.4,
                  .leaf_droop_deg = 30}},
    // A narrow column.
    TreeSpecies{
        .name = "poplar",
        .sway_deg = {1.4, 3.0, 9.2},
        .beta_horizontal = 0.1,
        .thinness_power = 0.6,
        .petiole = 1.0,
        .flutter = 1.0,
        .flutter_speed_m_s = 1.8,
        .habit = {.height_m = 15.0,
                  .trunk_share = 0.92,
                  .limb = {.first_at = 0.12, .angle_deg = {34, 18}, .length_share = {0.24, 0.1}, .lift_deg = 22},
                  .twig = {.first_at = 0.15, .angle_deg = {40, 25}, .length_share = {0.1, 0.07}, .lift_deg = 25},
                  .leaf_angle_deg = 60,
                  .leaf_length_m = 0.16,
                  .leaf_width_share = 0.75,
                  .leaf_droop_deg = 45}},
};

}  // namespace

const TreeSpecies& tree_species(std::string_view name) noexcept {
  return *std::find_if(kSpecies.begin(), kSpecies.end() - 1,
                       [name](const TreeSpecies& species) { return species.name == name; });
}

}  // namespace yuragi::scenes
