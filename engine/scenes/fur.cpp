#include <memory>
#include <utility>
#include <vector>

#include "engine/math/philox.hpp"
#include "engine/scenes/coat.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/strand_sway.hpp"

// Fur in the wind (Chiba, section 3.1): a coat on a curved body, and the wind that passes over it (StrandSway, which
// says how). Against grass: the noise is smooth (a large beta) and small, and travels slowly, as air does in a coat.

namespace yuragi {
namespace {

/// 16 m in 512 samples are cells of 3 cm: a lock of the coat.
constexpr StrandSwaySpec kFurSway = {.max_bend_rad = 0.9,
                                     .half_bend_speed_m_s = 8.0,
                                     .turbulence = 0.6,
                                     .gust_strength = 0.2,
                                     .hybrid = 0.4,
                                     .natural_hz = 4.0,
                                     .damping_ratio = 0.35,
                                     .carry = 0.06,
                                     .has_own_gusts = true,
                                     .noise = {.period_m = 16.0, .beta = 2.5}};

std::vector<Parameter> fur_parameters() {
  std::vector<Parameter> parameters = {
      {"hairs_along", "", std::int64_t{200}, 1, 4096, "rows of hairs from one end of the body to the other"},
      {"hairs_around", "", std::int64_t{150}, 1, 4096, "hairs in a row around the body"},
      {"links", "", std::int64_t{10}, 1, 64, "links of a hair"},
      {"body_length", "m", 1.6, 0.05, 20, "the body from end to end; it lies from west to east"},
      {"body_height", "m", 0.8, 0.05, 20, "the body from the ground up"},
      {"body_width", "m", 0.7, 0.05, 20, "the body from flank to flank"},
      {"hair_length", "m", 0.09, 0.002, 1, "length of a hair, on average"},
      {"hair_length_variation", "", 0.2, 0, 0.5, "standard deviation of the length, as a part of it"},
      {"lie", "deg", 55.0, 0, 85, "how far a hair's foot lies over in calm air"},
      {"curl", "deg", 30.0, 0, 180, "how much farther it curls to its tip"},
      {"parting", "deg", 20.0, 0, 90, "standard deviation of where hairs lie to"},
  };
  for (const Parameter& parameter : strand_sway_parameters(kFurSway)) parameters.push_back(parameter);
  return parameters;
}
const std::vector<Parameter> kFurParameters = fur_parameters();

Coat placed_coat(const ParameterValues& values, const SceneSetup& setup) {
  Coat coat = make_coat({.hairs_along = static_cast<std::size_t>(values.integer("hairs_along")),
                         .hairs_around = static_cast<std::size_t>(values.integer("hairs_around")),
                         .links = static_cast<std::size_t>(values.integer("links")),
                         .body_length_m = values.number("body_length"),
                         .body_height_m = values.number("body_height"),
                         .body_width_m = values.number("body_width"),
                         .length_m = values.number("hair_length"),
                         .length_variation = values.number("hair_length_variation"),
                         .lie_deg = values.number("lie"),
                         .curl_deg = values.number("curl"),
                         .parting_deg = values.number("parting"),
                         .seed = setup.seed});
  place(setup.placement, coat.skeleton);
  return coat;
}

std::unique_ptr<Scene> make_fur(const ParameterValues& values, const SceneSetup& setup) {
  Coat coat = placed_coat(values, setup);
  return std::make_unique<StrandSway>(coat.skeleton, coat.place_x_m, coat.place_z_m, std::move(coat.flexibility),
                                      strand_sway_spec(values, setup.seed ^ stream_id("wind in the fur")), setup);
}

}  // namespace

extern const SceneDescription kFurScene;
const SceneDescription kFurScene = {.name = "fur",
                                    .summary = "a coat on a curved body: the wind parts it and strokes over it",
                                    .parameters = kFurParameters,
                                    .make = make_fur};

}  // namespace yuragi
