#include <memory>
#include <string_view>
#include <vector>

#include "engine/math/philox.hpp"
#include "engine/scenes/blank_strands.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/strand_sway.hpp"

// The ground around all scenes: how grass is bent on a coarse grid, by the same wind and in the same way as the blades
// of the grass scene (StrandSway). A viewer grows grass to the horizon, bent as the nodes around each blade.

namespace yuragi::scenes {
namespace {

/// Enough for a viewer that shows nodes as blades.
constexpr std::size_t kNodeLinks = 4;

/// Waves of the canopy that nodes 2 m apart can hold.
constexpr StrandSwaySpec kGroundSway = {.noise = {}, .shortest_canopy_wave_m = 6.0};

std::vector<Parameter> ground_parameters() {
  std::vector<Parameter> parameters = {
      {"columns", "", std::int64_t{64}, 2, 512, "nodes from west to east; 64 x 64 are 8 Mbit/s of the stream"},
      {"rows", "", std::int64_t{64}, 2, 512, "nodes from north to south"},
      {"spacing", "m", 2.0, 0.25, 20, "from one node to the next; at 2 m and less the waves of the meadow are held"},
      {"blade_length", "m", 0.7, 0.02, 3, "length of the grass, on average"},
  };
  for (const Parameter& parameter : strand_sway_parameters(kGroundSway)) parameters.push_back(parameter);
  return parameters;
}
const std::vector<Parameter> kGroundParameters = ground_parameters();

/// Upright strands on a grid around the world's origin.
pose::StrandSkeleton ground_nodes(std::size_t columns, std::size_t rows, double spacing_m, double length_m) {
  pose::StrandSkeleton nodes = blank_strands(columns * rows, kNodeLinks);
  nodes.columns = columns;
  const auto place_m = [spacing_m](std::size_t i, std::size_t count) {
    return static_cast<float>((static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)) * spacing_m);
  };
  for (std::size_t node = 0; node < nodes.strand_count; ++node) {
    nodes.root_x_m[node] = place_m(node % columns, columns);
    nodes.root_z_m[node] = place_m(node / columns, rows);
    nodes.link_length_m[node] = static_cast<float>(length_m / static_cast<double>(kNodeLinks));
  }
  return nodes;
}

std::unique_ptr<Scene> make_ground(const ParameterValues& values, const SceneSetup& setup) {
  const auto size_in = [&values](std::string_view name) { return static_cast<std::size_t>(values.integer(name)); };
  pose::StrandSkeleton nodes =
      ground_nodes(size_in("columns"), size_in("rows"), values.number("spacing"), values.number("blade_length"));
  place(setup.placement, nodes);
  StrandSwaySpec spec = strand_sway_spec(values, setup.seed ^ math::stream_id("grass wind on the ground"));
  spec.shortest_canopy_wave_m = kGroundSway.shortest_canopy_wave_m;
  spec.plant_height_m = values.number("blade_length");
  std::vector<float> flexibility(nodes.padded_count(), 1.0F);
  const std::vector<float> x_m = nodes.root_x_m;
  const std::vector<float> z_m = nodes.root_z_m;
  spec.finest_wind_cell_m = values.number("spacing");
  return std::make_unique<StrandSway>(std::move(nodes), x_m, z_m, std::move(flexibility), spec, setup);
}

}  // namespace

extern const SceneDescription kGroundScene;
const SceneDescription kGroundScene = {
    .name = "ground",
    .summary = "the meadow to the horizon around all other scenes, as the bends of its grass on a coarse grid",
    .parameters = kGroundParameters,
    .make = make_ground};

}  // namespace yuragi::scenes
