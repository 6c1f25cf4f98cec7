#include <memory>
#include <string_view>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/math/philox.hpp"
#include "engine/scenes/blank_strands.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/strand_sway.hpp"

// The ground around all scenes: the bend of grass on a coarse grid, by the same wind and in the same way as the blades
// of the grass scene (StrandSway). A viewer draws grass to the horizon, bent by interpolation between the nodes.

namespace yuragi::scenes {
namespace {

/// Enough for a viewer that draws nodes as blades.
constexpr std::size_t kNodeLinks = 4;

/// Waves of the canopy that nodes 2 m apart can hold.
constexpr StrandSwaySpec kGroundSway = {.noise = {}, .shortest_canopy_wave_m = 6.0};

struct GroundSpec {
  std::size_t columns, rows;
  double spacing_m;
  double length_m;
};
const Fields<GroundSpec> kGroundFields = {
    {{"columns", "", std::int64_t{64}, 2, 512, "nodes from west to east; 64 x 64 are 8 Mbit/s of the stream"},
     &GroundSpec::columns},
    {{"rows", "", std::int64_t{64}, 2, 512, "nodes from north to south"}, &GroundSpec::rows},
    {{"spacing", "m", 2.0, 0.25, 20, "from one node to the next; at 2 m and less the waves of the meadow are held"},
     &GroundSpec::spacing_m},
    {{"blade_length", "m", 0.7, 0.02, 3, "length of the grass, on average"}, &GroundSpec::length_m},
};
const Fields<StrandSwaySpec> kGroundSwayFields = strand_sway_fields(kGroundSway);
const std::vector<Parameter> kGroundParameters = together(kGroundFields.parameters(), kGroundSwayFields.parameters());

/// Upright strands on a grid around the world's origin.
pose::StrandSkeleton ground_nodes(const GroundSpec& ground) {
  pose::StrandSkeleton nodes = blank_strands(ground.columns * ground.rows, kNodeLinks);
  nodes.columns = ground.columns;
  const auto place_m = [&ground](std::size_t i, std::size_t count) {
    return static_cast<float>((static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)) * ground.spacing_m);
  };
  for (std::size_t node = 0; node < nodes.strand_count; ++node) {
    nodes.root_x_m[node] = place_m(node % ground.columns, ground.columns);
    nodes.root_z_m[node] = place_m(node / ground.columns, ground.rows);
    nodes.link_length_m[node] = static_cast<float>(ground.length_m / static_cast<double>(kNodeLinks));
  }
  return nodes;
}

std::unique_ptr<Scene> make_ground(const ParameterValues& values, const Setup& setup) {
  const GroundSpec ground = kGroundFields.of(values);
  pose::StrandSkeleton nodes = ground_nodes(ground);
  place(setup.placement, nodes);
  StrandSwaySpec sway = kGroundSwayFields.of(values);
  sway.noise.seed = setup.seed ^ math::stream_id("grass wind on the ground");
  sway.shortest_canopy_wave_m = kGroundSway.shortest_canopy_wave_m;
  sway.plant_height_m = ground.length_m;
  sway.finest_wind_cell_m = ground.spacing_m;
  std::vector<float> flexibility(nodes.padded_count(), 1.0F);
  const std::vector<float> x_m = nodes.root_x_m;
  const std::vector<float> z_m = nodes.root_z_m;
  return std::make_unique<StrandSway>(std::move(nodes), x_m, z_m, std::move(flexibility), sway, setup);
}

}  // namespace

extern const Description kGroundScene;
const Description kGroundScene = {
    .name = "ground",
    .summary = "the meadow to the horizon around all other scenes, as the bends of its grass on a coarse grid",
    .parameters = kGroundParameters,
    .make = make_ground};

}  // namespace yuragi::scenes
