#include <array>
#include <cmath>
#include <vector>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/scenes/cloth.hpp"
#include "engine/scenes/cloth_noise.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"

// A curtain in the wind, after N. Chiba, "Development of core technology for a noise-based real-time animation engine
// for fluctuation phenomena" (Iwate University), section 3.2 and figures 9 and 10:
//
//   shift    the wind carries a 2-D noise along the curtain: as it blows along it, so the waves run        ShiftJob
//   sample   each column reads it where it hangs                                                           SampleJob
//   project  a base sway for the whole cloth, and the noise propagates from the top to the hem, growing    Cloth
//
// At rest it hangs in gathered folds that open a little toward the hem.

namespace yuragi {
namespace {

const std::array kCurtainParameters = {
    Parameter{"columns", "", std::int64_t{200}, 2, 4000, "threads from one side to the other"},
    Parameter{"rows", "", std::int64_t{150}, 2, 4000, "joints from the top to the hem"},
    Parameter{"width", "m", 3.0, 0.1, 100, "from one side to the other"},
    Parameter{"height", "m", 2.4, 0.1, 50, "from the top to the hem"},
    Parameter{"clearance", "m", 0.1, 0, 50, "between the hem and the ground"},
    Parameter{"folds", "", 11.0, 0, 200, "folds that it is gathered in"},
    Parameter{"fold_depth", "m", 0.07, 0, 1, "of a fold, from crest to trough, at the top"},
    Parameter{"max_sway", "deg", 50.0, 0, 80, "how far the strongest wind blows it up"},
    Parameter{"max_flutter", "deg", 50.0, 0, 80, "how far the strongest wind makes the hem flutter about that"},
    Parameter{"half_sway_speed", "m/s", 5.0, 0.1, 60, "the wind that moves it half as much"},
    Parameter{"give_sideways", "", 0.25, 0, 1, "how far it gives way along itself, as a part of how far across"},
    Parameter{"travel_time", "s", 0.9, 0, 10, "that the noise takes from the top to the hem"},
    Parameter{"growth", "", 0.8, 0, 4, "the noise grows as the way from the top to this power"},
    Parameter{"quickness", "rad/s", 11.0, 0.5, 50, "how quickly it follows; heavier cloth has less"},
    Parameter{"hybrid", "", 0.0, 0, 1, "0: the noise alone; 1: dynamics of a coarse cloth, with the noise as detail"},
    Parameter{"tile_period", "m", 20.0, 2, 4096, "the longest wave of the noise; 128 samples"},
    Parameter{"beta", "", 5.0 / 3.0, kMinTransectBeta2, 4, "exponent of the noise's spectrum along a line, 1/f^beta"},
};

ClothSpec curtain_spec(const ParameterValues& values) {
  return {.rows = static_cast<std::size_t>(values.integer("rows")),
          .length_m = values.number("height"),
          .travel_time_s = values.number("travel_time"),
          .growth_exponent = values.number("growth"),
          .quickness_rad_s = values.number("quickness"),
          .largest_sway = lean_of_deg(values.number("max_sway")),
          .largest_wave = lean_of_deg(values.number("max_flutter")),
          .hybrid = values.number("hybrid"),
          .normal_drag_per_m = drag_per_m(values.number("half_sway_speed")),
          .skin_drag_per_m = 0.05 * drag_per_m(values.number("half_sway_speed"))};
}

/// The columns from west to east at a heading of 0, folded toward north and south.
ClothEdge curtain_edge(const ParameterValues& values, const SceneSetup& setup) {
  ClothEdge edge(static_cast<std::size_t>(values.integer("columns")));
  const double height_m = values.number("height");
  const double depth_m = 0.5 * values.number("fold_depth");
  const double pitch_m = values.number("width") / static_cast<double>(edge.columns - 1);
  const RandomStream random(setup.seed, stream_id("curtain folds"));
  const double first_phase_rad = 2.0 * kPi * random.uniform(0);
  const double second_phase_rad = 2.0 * kPi * random.uniform(1);
  for (std::size_t column = 0; column < edge.stride(); ++column) {
    // No two folds are alike: their phase and depth stray slowly along the curtain.
    const double along = static_cast<double>(column) / static_cast<double>(edge.columns - 1);
    const double stray = std::sin(2.0 * kPi * 1.7 * along + first_phase_rad);
    const double fold = std::sin(2.0 * kPi * values.number("folds") * along + 0.9 * stray + second_phase_rad) *
                        (1.0 + 0.25 * std::sin(2.0 * kPi * 2.9 * along + second_phase_rad));
    const Turned place =
        turned(setup.placement, pitch_m * static_cast<double>(column) - 0.5 * values.number("width"), depth_m * fold);
    edge.x_m[column] = static_cast<float>(setup.placement.x_m + place.east);
    edge.y_m[column] = static_cast<float>(setup.placement.y_m + height_m + values.number("clearance"));
    edge.z_m[column] = static_cast<float>(setup.placement.z_m + place.south);

    // The hem's folds are half as deep again.
    const Turned lean = turned(setup.placement, 0.0, std::tan(0.5 * std::atan(0.5 * depth_m * fold / height_m)));
    edge.lean_east[column] = static_cast<float>(lean.east);
    edge.lean_south[column] = static_cast<float>(lean.south);
  }
  return edge;
}

class Curtain final : public Scene {
 public:
  Curtain(const ParameterValues& values, const SceneSetup& setup)
      : Curtain(curtain_edge(values, setup), values, setup) {}

  const Skeleton& skeleton() const noexcept override { return cloth_.skeleton(); }
  const Pose& pose() const noexcept override { return cloth_.pose(); }
  double largest_joint_step_m(double dt_s) const noexcept override { return cloth_.largest_joint_step_m(dt_s); }

  void shift(const GroundWind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    noise_.shift(wind_.east_m_s(), wind_.south_m_s(), dt_s);
  }
  void sample() noexcept override { noise_.sample(flutter_); }

  void project(double dt_s) noexcept override {
    // How much the wind blows: toward where, across the curtain and, less, along it. Like the drag of the air it grows
    // with the square of a weak wind, and it saturates: s^2 / (1 + s^2).
    const double speed_m_s = wind_.speed_m_s();
    const double s = speed_m_s / half_sway_speed_m_s_;
    const double strength = s * s / (1.0 + s * s);
    const double per_speed = speed_m_s > 0.0 ? strength / speed_m_s : 0.0;
    const double along = (wind_.east_m_s() * along_.east + wind_.south_m_s() * along_.south) * per_speed;
    const double across = (wind_.south_m_s() * along_.east - wind_.east_m_s() * along_.south) * per_speed;
    const double swell = 0.7 + own_swell_ * static_cast<double>(noise_.swell());
    const double sway_along = swell * max_sway_ * give_sideways_ * along;
    const double sway_across = swell * max_sway_ * across;
    const auto sway_east = static_cast<float>(sway_along * along_.east - sway_across * along_.south);
    const auto sway_south = static_cast<float>(sway_along * along_.south + sway_across * along_.east);
    const auto wave_east = static_cast<float>(-max_wave_ * strength * along_.south);
    const auto wave_south = static_cast<float>(max_wave_ * strength * along_.east);

    // All of it sways, and the noise runs down it.
    const std::span<float> sway = cloth_.sway();
    const std::span<float> wave = cloth_.wave();
    const std::size_t stride = flutter_.size();
    for (std::size_t column = 0; column < stride; ++column) {
      sway[column] = sway_east;
      sway[stride + column] = sway_south;
      wave[column] = flutter_[column] * wave_east;
      wave[stride + column] = flutter_[column] * wave_south;
    }
    cloth_.blow(wind_.east_m_s(), wind_.south_m_s(), flutter_);
    cloth_.project(dt_s);
  }

 private:
  Curtain(const ClothEdge& edge, const ParameterValues& values, const SceneSetup& setup)
      : half_sway_speed_m_s_(values.number("half_sway_speed")),
        give_sideways_(values.number("give_sideways")),
        max_sway_(lean_of_deg(values.number("max_sway"))),
        max_wave_(lean_of_deg(values.number("max_flutter"))),
        along_(turned(setup.placement, 1.0, 0.0)),
        own_swell_(setup.gusts ? 0.0 : 0.3),
        wind_(setup.placement, setup.gusts),
        noise_(values, setup.seed ^ stream_id("curtain noise"), edge.x_m, edge.z_m, setup.row),
        flutter_(edge.stride(), 0.0F),
        cloth_(curtain_spec(values), edge, setup.row) {}

  double half_sway_speed_m_s_;
  double give_sideways_;
  double max_sway_;  ///< leans
  double max_wave_;
  Turned along_;  ///< the curtain's own direction, from the first column to the last

  double own_swell_;  ///< how much the whole of it swells by itself; gusts from outside are swell enough
  SceneWind wind_;
  ClothNoise noise_;
  std::vector<float> flutter_;  ///< each column's noise
  Cloth cloth_;
};

}  // namespace

extern const SceneDescription kCurtainScene;
const SceneDescription kCurtainScene = {.name = "curtain",
                                        .summary = "a curtain that billows, and waves that run down and along it",
                                        .parameters = kCurtainParameters,
                                        .make = [](const ParameterValues& values, const SceneSetup& setup) {
                                          return std::unique_ptr<Scene>(std::make_unique<Curtain>(values, setup));
                                        }};

}  // namespace yuragi
