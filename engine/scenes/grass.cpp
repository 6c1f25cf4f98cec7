#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/math/philox.hpp"
#include "engine/scenes/meadow.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/strand_sway.hpp"

// Grass in the wind (Chiba, section 3.1): a meadow laid out by noise, and the wind on the ground that passes over it
// (StrandSway).

namespace yuragi::scenes {
namespace {

/// 256 m in 512 samples are cells of 0.5 m: frequencies stay below half the tick rate up to 30 m/s at 60 Hz (|k| U < pi
/// rate), so that in a storm no blade jitters from tick to tick.
constexpr StrandSwaySpec kGrassSway = {};

const Fields<MeadowSpec> kMeadowFields = {
    {{"blades_across", "", std::int64_t{100}, 1, 2000, "blades from west to east"}, &MeadowSpec::blades_across},
    {{"blades_deep", "", std::int64_t{100}, 1, 2000, "blades from north to south"}, &MeadowSpec::blades_deep},
    {{"links", "", std::int64_t{10}, 1, 64, "links of a blade"}, &MeadowSpec::links},
    {{"width", "m", 7.0, 0.1, 200, "the meadow from west to east"}, &MeadowSpec::width_m},
    {{"depth", "m", 7.0, 0.1, 200, "the meadow from north to south"}, &MeadowSpec::depth_m},
    {{"blade_length", "m", 0.7, 0.05, 3, "length of a blade, on average"}, &MeadowSpec::length_m},
    {{"blade_length_variation", "", 0.25, 0, 0.5, "standard deviation of the length, as a part of it"},
     &MeadowSpec::length_variation},
    {{"tilt", "deg", 8.0, 0, 60, "how far a blade's foot leans in calm air, on average"}, &MeadowSpec::tilt_deg},
    {{"curl", "deg", 35.0, 0, 180, "how far a blade droops from foot to tip in calm air, on average"},
     &MeadowSpec::curl_deg},
    {{"droop_heading", "deg", 0.0, 0, 360, "mean direction in which blades droop, clockwise from north"},
     &MeadowSpec::heading_deg},
    {{"droop_spread", "deg", 150.0, 0, 180, "standard deviation of the direction in which they droop"},
     &MeadowSpec::heading_spread_deg},
};
const Fields<StrandSwaySpec> kGrassSwayFields = strand_sway_fields(kGrassSway);
const std::vector<Parameter> kGrassParameters = together(kMeadowFields.parameters(), kGrassSwayFields.parameters());

std::unique_ptr<Scene> make_grass(const ParameterValues& values, const Setup& setup) {
  MeadowSpec blades = kMeadowFields.of(values);
  blades.seed = setup.seed;
  Meadow meadow = make_meadow(blades);
  place(setup.placement, meadow.skeleton);
  StrandSwaySpec sway = kGrassSwayFields.of(values);
  sway.noise.seed = setup.seed ^ math::stream_id("grass wind on the ground");
  sway.plant_height_m = blades.length_m;
  return std::make_unique<StrandSway>(meadow.skeleton, meadow.skeleton.root_x_m, meadow.skeleton.root_z_m,
                                      std::move(meadow.flexibility), sway, setup);
}

}  // namespace

extern const Description kGrassScene;
const Description kGrassScene = {.name = "grass",
                                 .summary = "a meadow in the wind: blades bend as gusts pass over them",
                                 .parameters = kGrassParameters,
                                 .make = make_grass};

}  // namespace yuragi::scenes
