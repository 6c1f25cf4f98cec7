#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/math/philox.hpp"
#include "engine/scenes/meadow.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/strand_sway.hpp"

// Grass in the wind (Chiba, section 3.1): a meadow laid out by noise, and the wind on the ground that passes over it
// (StrandSway).

namespace yuragi::scenes {
namespace {

/// 256 m in 512 samples are cells of 0.5 m: what is read stays below half the tick rate up to 30 m/s at 60 Hz
/// (|k| U < pi rate), so that in a storm no blade jitters from tick to tick.
constexpr StrandSwaySpec kGrassSway = {};

std::vector<Parameter> grass_parameters() {
  std::vector<Parameter> parameters = {
      {"blades_across", "", std::int64_t{100}, 1, 2000, "blades from west to east"},
      {"blades_deep", "", std::int64_t{100}, 1, 2000, "blades from north to south"},
      {"links", "", std::int64_t{10}, 1, 64, "links of a blade"},
      {"width", "m", 7.0, 0.1, 200, "the meadow from west to east"},
      {"depth", "m", 7.0, 0.1, 200, "the meadow from north to south"},
      {"blade_length", "m", 0.7, 0.05, 3, "length of a blade, on average"},
      {"blade_length_variation", "", 0.25, 0, 0.5, "standard deviation of the length, as a part of it"},
      {"tilt", "deg", 8.0, 0, 60, "how far a blade's foot leans in calm air, on average"},
      {"curl", "deg", 35.0, 0, 180, "how far a blade droops from foot to tip in calm air, on average"},
      {"droop_heading", "deg", 0.0, 0, 360, "where blades droop to on average, clockwise from north"},
      {"droop_spread", "deg", 150.0, 0, 180, "standard deviation of where they droop to"},
  };
  for (const Parameter& parameter : strand_sway_parameters(kGrassSway)) parameters.push_back(parameter);
  return parameters;
}
const std::vector<Parameter> kGrassParameters = grass_parameters();

std::size_t size_in(const ParameterValues& values, std::string_view name) {
  return static_cast<std::size_t>(values.integer(name));
}

Meadow placed_meadow(const ParameterValues& values, const SceneSetup& setup) {
  Meadow meadow = make_meadow({.blades_across = size_in(values, "blades_across"),
                               .blades_deep = size_in(values, "blades_deep"),
                               .links = size_in(values, "links"),
                               .width_m = values.number("width"),
                               .depth_m = values.number("depth"),
                               .length_m = values.number("blade_length"),
                               .length_variation = values.number("blade_length_variation"),
                               .tilt_deg = values.number("tilt"),
                               .curl_deg = values.number("curl"),
                               .heading_deg = values.number("droop_heading"),
                               .heading_spread_deg = values.number("droop_spread"),
                               .seed = setup.seed});
  place(setup.placement, meadow.skeleton);
  return meadow;
}

std::unique_ptr<Scene> make_grass(const ParameterValues& values, const SceneSetup& setup) {
  Meadow meadow = placed_meadow(values, setup);
  StrandSwaySpec spec = strand_sway_spec(values, setup.seed ^ math::stream_id("grass wind on the ground"));
  spec.plant_height_m = values.number("blade_length");
  return std::make_unique<StrandSway>(meadow.skeleton, meadow.skeleton.root_x_m, meadow.skeleton.root_z_m,
                                      std::move(meadow.flexibility), spec, setup);
}

}  // namespace

extern const SceneDescription kGrassScene;
const SceneDescription kGrassScene = {.name = "grass",
                                      .summary = "a meadow in the wind: blades bend as gusts pass over them",
                                      .parameters = kGrassParameters,
                                      .make = make_grass};

}  // namespace yuragi::scenes
