#include <array>
#include <cmath>
#include <vector>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/scenes/cloth.hpp"
#include "engine/scenes/cloth_noise.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"

// A flag on its pole, after N. Chiba, "Development of core technology for a noise-based real-time animation engine for
// fluctuation phenomena" (Iwate University), section 3.2 and figure 11:
//
//   shift    the wind carries a 2-D noise along the flag, at its own speed                          ShiftJob
//   sample   each column, a thread at its height, reads it                                         SampleJob
//   project  the wind lifts the flag and turns it downwind: the base sway; and the noise           Cloth
//            propagates from the hoist to the fly, growing
//
// Row 0 is the hoist, from top to bottom. At rest the flag hangs limp beside its pole, for so does a real one when
// there is no wind: each thread nearly straight down from where it is fixed, out toward the scene's north by `droop`.
// It is lifted as a hanging thing is that the wind blows against; and since a limp flag may swing to any side, a wind
// that turns, or that comes back from elsewhere, takes it along without a jump.

namespace yuragi {
namespace {

const std::array kFlagParameters = {
    Parameter{"columns", "", std::int64_t{200}, 2, 4000, "threads from the top to the bottom"},
    Parameter{"rows", "", std::int64_t{150}, 2, 4000, "joints from the hoist to the fly"},
    Parameter{"length", "m", 1.8, 0.1, 50, "from the hoist to the fly"},
    Parameter{"hoist", "m", 1.2, 0.1, 50, "along the pole"},
    Parameter{"pole_height", "m", 5.0, 0, 200, "of the flag's top above the ground"},
    Parameter{"droop", "deg", 12.0, 0, 60, "how far from straight down it hangs in calm air"},
    Parameter{"folds", "", 3.5, 0, 50, "folds that it hangs in"},
    Parameter{"fold_angle", "deg", 8.0, 0, 45, "how far the folds stand out to the sides"},
    Parameter{"max_lift", "deg", 86.0, 0, 90, "how far from straight down the strongest wind lifts it"},
    Parameter{"max_flutter", "deg", 75.0, 0, 90, "how far the strongest wind makes the fly flutter"},
    Parameter{"half_lift_speed", "m/s", 3.5, 0.1, 60, "the wind that lifts it half as much"},
    Parameter{"travel_time", "s", 1.0, 0, 10, "that the noise takes from the hoist to the fly"},
    Parameter{"growth", "", 0.7, 0, 4, "the noise grows as the way from the hoist to this power"},
    Parameter{"quickness", "rad/s", 20.0, 0.5, 50, "how quickly it follows; heavier cloth has less"},
    Parameter{"hybrid", "", 0.0, 0, 1, "0: the noise alone; 1: dynamics of a coarse cloth, with the noise as detail"},
    Parameter{"tile_period", "m", 10.0, 2, 4096, "the longest wave of the noise; 128 samples"},
    Parameter{"beta", "", 1.0, kMinTransectBeta2, 4, "exponent of the noise's spectrum along a line, 1/f^beta"},
};

/// A part of the flutter lifts and lowers, as cloth that is not quite flat does.
constexpr double kLiftFlutter = 0.25;

/// Which way the noise's tiles are read along the flag: at no simple slope, so that none comes round (as figure 4a).
constexpr double kAlongNoiseX = 0.8506508083520399;  // of a golden rectangle's diagonal
constexpr double kAlongNoiseZ = 0.5257311121191336;

/// How much the noise changes from the top to the bottom, against its change along the flag: a wave's front goes from
/// top to bottom nearly straight.
constexpr double kHeightOnNoise = 0.3;

ClothSpec flag_spec(const ParameterValues& values) {
  // The sway takes the flag from rest to where it is lifted, so it is no longer than both leans together.
  return {.rows = static_cast<std::size_t>(values.integer("rows")),
          .length_m = values.number("length"),
          .travel_time_s = values.number("travel_time"),
          .growth_exponent = values.number("growth"),
          .quickness_rad_s = values.number("quickness"),
          .largest_sway = lean_of_deg(values.number("max_lift")) +
                          std::hypot(lean_of_deg(values.number("droop")), lean_of_deg(values.number("fold_angle"))),
          .largest_wave = lean_of_deg(values.number("max_flutter")) * std::hypot(1.0, kLiftFlutter),
          .hybrid = values.number("hybrid"),
          .normal_drag_per_m = 4.0 * drag_per_m(values.number("half_lift_speed")),
          .skin_drag_per_m = 1.0 * drag_per_m(values.number("half_lift_speed"))};
}

/// The columns from the top down, on the pole.
ClothEdge flag_edge(const ParameterValues& values, const SceneSetup& setup) {
  ClothEdge edge(static_cast<std::size_t>(values.integer("columns")));
  const double pitch_m = values.number("hoist") / static_cast<double>(edge.columns - 1);
  const RandomStream random(setup.seed, stream_id("flag folds"));
  const double phase_rad = 2.0 * kPi * random.uniform(0);
  for (std::size_t column = 0; column < edge.stride(); ++column) {
    const double along = static_cast<double>(column) / static_cast<double>(edge.columns - 1);
    const double fold = std::sin(2.0 * kPi * values.number("folds") * along + phase_rad);
    edge.x_m[column] = static_cast<float>(setup.placement.x_m);
    edge.y_m[column] =
        static_cast<float>(setup.placement.y_m + values.number("pole_height") - pitch_m * static_cast<double>(column));
    edge.z_m[column] = static_cast<float>(setup.placement.z_m);
    const Turned lean =
        turned(setup.placement, fold * lean_of_deg(values.number("fold_angle")), -lean_of_deg(values.number("droop")));
    edge.lean_east[column] = static_cast<float>(lean.east);
    edge.lean_south[column] = static_cast<float>(lean.south);
  }
  return edge;
}

class Flag final : public Scene {
 public:
  Flag(const ParameterValues& values, const SceneSetup& setup) : Flag(flag_edge(values, setup), values, setup) {}

  const Skeleton& skeleton() const noexcept override { return cloth_.skeleton(); }
  const Pose& pose() const noexcept override { return cloth_.pose(); }
  double largest_joint_step_m(double dt_s) const noexcept override { return cloth_.largest_joint_step_m(dt_s); }

  void shift(const GroundWind& wind, double dt_s) noexcept override {
    // A flag stands along the wind, so the noise goes along it as the wind does.
    wind_.step(wind, dt_s);
    const double speed_m_s = wind_.speed_m_s();
    noise_.shift(speed_m_s * kAlongNoiseX, speed_m_s * kAlongNoiseZ, dt_s);
  }
  void sample() noexcept override { noise_.sample(flutter_); }

  void project(double dt_s) noexcept override {
    // How much the wind lifts, and toward where. The flag gives up its droop and its folds as it is lifted.
    const double speed_m_s = wind_.speed_m_s();
    const double swell = static_cast<double>(noise_.swell());
    const double s = speed_m_s / half_lift_speed_m_s_;
    const double strength = s * s / (1.0 + s * s);
    const double per_speed = speed_m_s > 0.0 ? strength / speed_m_s : 0.0;
    const double east = wind_.east_m_s() * per_speed;
    const double south = wind_.south_m_s() * per_speed;
    const double lift = max_lift_ * (0.92 + 0.08 * swell);
    const auto lift_east = static_cast<float>(lift * east);
    const auto lift_south = static_cast<float>(lift * south);
    const auto given_up = static_cast<float>(strength);

    // All of it is lifted, and the noise runs along it, to both sides of the wind and a little up and down.
    const auto wave_east = static_cast<float>(max_wave_ * (kLiftFlutter * swell * east - south));
    const auto wave_south = static_cast<float>(max_wave_ * (kLiftFlutter * swell * south + east));
    const std::span<float> sway = cloth_.sway();
    const std::span<float> wave = cloth_.wave();
    const std::size_t stride = flutter_.size();
    for (std::size_t column = 0; column < stride; ++column) {
      sway[column] = lift_east - given_up * rest_east_[column];
      sway[stride + column] = lift_south - given_up * rest_south_[column];
      wave[column] = flutter_[column] * wave_east;
      wave[stride + column] = flutter_[column] * wave_south;
    }
    cloth_.blow(wind_.east_m_s(), wind_.south_m_s(), flutter_);
    cloth_.project(dt_s);
  }

 private:
  Flag(const ClothEdge& edge, const ParameterValues& values, const SceneSetup& setup)
      : half_lift_speed_m_s_(values.number("half_lift_speed")),
        max_lift_(lean_of_deg(values.number("max_lift"))),
        max_wave_(lean_of_deg(values.number("max_flutter"))),
        rest_east_(edge.lean_east),
        rest_south_(edge.lean_south),
        wind_(setup.placement, setup.gusts),
        noise_(values, setup.seed ^ stream_id("flag noise"), heights_on_noise(edge, -kAlongNoiseZ),
               heights_on_noise(edge, kAlongNoiseX), setup.row),
        flutter_(edge.stride(), 0.0F),
        cloth_(flag_spec(values), edge, setup.row) {}

  /// How far below the top each column is, along one axis of the noise.
  static std::vector<float> heights_on_noise(const ClothEdge& edge, double axis) {
    std::vector<float> heights_m = edge.y_m;
    const float top_m = heights_m.front();
    for (float& height_m : heights_m) {
      height_m = static_cast<float>(kHeightOnNoise * axis * static_cast<double>(top_m - height_m));
    }
    return heights_m;
  }

  double half_lift_speed_m_s_;
  double max_lift_;  ///< leans
  double max_wave_;
  std::vector<float> rest_east_, rest_south_;  ///< each column's lean at rest

  SceneWind wind_;
  ClothNoise noise_;
  std::vector<float> flutter_;  ///< each column's noise
  Cloth cloth_;
};

}  // namespace

extern const SceneDescription kFlagScene;
const SceneDescription kFlagScene = {.name = "flag",
                                     .summary = "a flag that hangs limp in calm air, and flies downwind of its pole",
                                     .parameters = kFlagParameters,
                                     .make = [](const ParameterValues& values, const SceneSetup& setup) {
                                       return std::unique_ptr<Scene>(std::make_unique<Flag>(values, setup));
                                     }};

}  // namespace yuragi
