#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/math/portable.hpp"
#include "engine/math/trig.hpp"
#include "engine/operators/oscillator_job.hpp"
#include "engine/scenes/cloth.hpp"
#include "engine/scenes/cloth_parameters.hpp"
#include "engine/scenes/cloth_strength.hpp"
#include "engine/scenes/cloth_waves.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"

// A flag on its pole, after N. Chiba, "Development of core technology for a noise-based real-time animation engine for
// fluctuation phenomena" (Iwate University), section 3.2 and figure 11:
//
//   shift    waves run along the flag, from the hoist to the fly, at a part of the wind's speed        ShiftJob
//   sample   each link of the cloth reads them where it is                                             SampleJob
//   project  the wind lifts the flag and turns it downwind: the base sway; and the waves turn its      Cloth
//            links to the sides, growing toward the fly
//
// The shifting operator makes them propagate: a link reads the value that was at the hoist earlier, by the link's
// distance from it, at any speed, also a changing one. So the frequency of the flutter goes with the wind (Taneda 1968,
// Waving motions of flags; Shelley and Zhang 2011, Flapping and bending bodies interacting with fluid flows: f L / U
// from 0.35 to 0.6, and amplitudes that grow to the fly), and the waves are not the wind's own gusts, which are longer
// and slower: a flag flutters by itself.
//
// Drag and weight lift it: tan(lift) = (u / u_h)^2, where the drag 0.5 rho C_D u^2 is the weight m g of the cloth: at
// 3 m/s for light nylon of 0.07 kg/m2 with the C_D of 0.12 of a fluttering flag (Munson and others, Fundamentals of
// fluid mechanics). It comes and goes as a damped oscillator, so that the flag sinks in a lull and rises with a gust.
//
// It hangs from the upper hoist corner: tension runs from there to the lower fly corner, and folds lie along it. So
// fronts of the waves lean: the lower, the later. At the free corners of the fly nothing holds the cloth: waves turn it
// farther there, and it curls, the lower corner more.
//
// Row 0 is the hoist, from top to bottom. At rest the flag hangs limp beside its pole, like a real one without wind:
// each thread nearly straight down from where it is fixed, out toward the scene's north by `droop`. It is lifted like
// any hanging thing in the wind; and because a limp flag can swing to any side, a wind that turns, or returns from
// another direction, moves it without a jump.
//
// The bound of largest_joint_step_m. A link's lean is l = tan(lift / 2) downwind, turned by the wave's angle psi. l is
// an oscillator that a vector of length 1 at most drives: it is never longer than G = largest_gain and changes by at
// most R = largest_rate a second (oscillator_job.hpp). psi is A S g c n: n changes by at most d_n a tick
// (ClothNoise::largest_change, carried at no more than the fastest), S by d_S (ClothStrength), and S, g are 1 at most,
// and c, of the curl, 1 + kLowerCurl.
// What is kept of the rest lean is cos^2(lift), which changes by at most 2 a unit of l. So a lean changes by at most
//   R dt (1 + 2 rest) + G A (1 + kLowerCurl) (d_n + 2.2 d_S).

namespace yuragi::scenes {
namespace {

/// kFlagFields defines each.
struct FlagSettings {
  std::size_t columns;
  std::size_t rows;
  double length_m;
  double hoist_m;
  double pole_height_m;
  double droop_deg;
  double folds;
  double fold_angle_deg;
  double half_lift_speed_m_s;
  double lift_rate_hz;
  double max_flutter_deg;
  double half_flutter_speed_m_s;
  double wave_length_m;
  double wave_speed;
  double growth;
  double edge_flutter;
  double hybrid;
};

const Fields<FlagSettings> kFlagFields = {
    {{"columns", "", std::int64_t{200}, 2, 4000, "threads from the top to the bottom"}, &FlagSettings::columns},
    {{"rows", "", std::int64_t{150}, 2, 4000, "joints from the hoist to the fly"}, &FlagSettings::rows},
    {{"length", "m", 1.8, 0.1, 50, "from the hoist to the fly"}, &FlagSettings::length_m},
    {{"hoist", "m", 1.2, 0.1, 50, "along the pole"}, &FlagSettings::hoist_m},
    {{"pole_height", "m", 5.0, 0, 200, "of the flag's top above the ground"}, &FlagSettings::pole_height_m},
    {{"droop", "deg", 20.0, 0, 60, "how far from straight down it hangs in calm air, on average"},
     &FlagSettings::droop_deg},
    {{"folds", "", 1.5, 0, 50, "folds that it hangs in"}, &FlagSettings::folds},
    {{"fold_angle", "deg", 4.0, 0, 45, "how far the folds stand out to the sides"}, &FlagSettings::fold_angle_deg},
    {{"half_lift_speed", "m/s", 3.0, 0.1, 60, "the wind that lifts it half way; heavier cloth needs more"},
     &FlagSettings::half_lift_speed_m_s},
    {{"lift_rate", "Hz", 1.0, 0.05, 10, "how quickly it rises and sinks; less: it lags behind the gusts"},
     &FlagSettings::lift_rate_hz},
    {{"max_flutter", "deg", 84.0, 0, 120, "how far the strongest waves turn the fly to the sides"},
     &FlagSettings::max_flutter_deg},
    {{"half_flutter_speed", "m/s", 4.0, 0.1, 60, "the wind that makes its waves half as high"},
     &FlagSettings::half_flutter_speed_m_s},
    {{"wave_length", "m", 2.1, 0.2, 100, "of the longest waves; shorter ones make it flutter faster"},
     &FlagSettings::wave_length_m},
    {{"wave_speed", "", 0.6, 0, 2, "how fast the waves run to the fly, as a part of the wind's speed"},
     &FlagSettings::wave_speed},
    {{"growth", "", 0.8, 0.1, 4,
      "how the waves grow from the hoist to the fly: the exponent of their growth with the distance; more: a calmer "
      "hoist"},
     &FlagSettings::growth},
    {{"edge_flutter", "", 0.25, 0, 1, "how high the short waves near the fly are, as a part of the long ones"},
     &FlagSettings::edge_flutter},
    {{"hybrid", "", 0.0, 0, 1, "0: the noise alone; 1: dynamics of a coarse cloth, with the noise as detail"},
     &FlagSettings::hybrid},
    kClothColor,
    kClothColor2,
    kClothImage,
};

/// Maximum speed of a wave: 0.2 m a tick, so that the shortest ones visibly run, and do not jump.
constexpr double kFastestWave_m_s = 12.0;

/// Ratios of the longest waves to the shortest, and of the edge's longest to the longest, and the position along the
/// flag at which the edge begins.
constexpr double kFlagBand = 2.0;
constexpr double kFlagEdgeWaves = 1.0 / 3.0;
constexpr double kFlagEdgeBegins = 0.6;

/// The noise's change from the top to the bottom, relative to its change along the flag: a wave's front is nearly
/// straight from top to bottom.
constexpr double kHeightOnNoise = 0.3;

/// The lean of the waves' fronts from the hoist: the tangent, which becomes 35 degrees of the cloth.
constexpr double kFoldSlant = 0.7;

/// The additional turn of the cloth by the waves at the lower and the upper fly corner, relative to the cloth beside
/// it, and the position along the flag at which it begins.
constexpr double kLowerCurl = 0.9;
constexpr double kUpperCurl = 0.45;
constexpr double kCurlBegins = 0.72;

/// In the longest waves; the edge's shortest waves then have five.
constexpr double kKnotsAWave = 32.0;

constexpr double kFlagLiftDamping = 0.7;

ClothSpec flag_spec(const FlagSettings& settings) {
  return {.rows = settings.rows,
          .length_m = settings.length_m,
          .knots_across_m = 0.1,
          .knots_along_m = settings.wave_length_m / kKnotsAWave,
          .hybrid = settings.hybrid,
          .normal_drag_per_m = 4.0 * drag_per_m(settings.half_lift_speed_m_s),
          .skin_drag_per_m = 1.0 * drag_per_m(settings.half_lift_speed_m_s)};
}

/// The angle between the lowest thread and the highest, from the position at which their ends are nearest to each
/// other. With threads of length l at an angle d, hoist h apart, and d as small a step as this, their distance squared
/// is h^2 - 2 h l step sin(d) + l^2 step^2, which is least, (h cos(d))^2, at h sin(d) / l. No thread hangs to the other
/// side.
double droop_fan_rad(const FlagSettings& settings) {
  const double droop_rad = settings.droop_deg * kRadPerDeg;
  return std::min(settings.hoist_m / settings.length_m * std::sin(droop_rad), 2.0 * droop_rad);
}

/// The droop of a thread that begins at this position on the pole (0 the top, 1 the bottom).
double droop_at_deg(const FlagSettings& settings, double along) {
  return settings.droop_deg + (along - 0.5) * droop_fan_rad(settings) / kRadPerDeg;
}

/// The columns from the top down, on the pole.
ClothEdge flag_edge(const FlagSettings& settings, const Setup& setup) {
  ClothEdge edge(settings.columns);
  const double pitch_m = settings.hoist_m / static_cast<double>(edge.columns - 1);
  const math::RandomStream random(setup.seed, math::stream_id("flag folds"));
  const double phase_rad = 2.0 * kPi * random.uniform(0);
  for (std::size_t column = 0; column < edge.stride(); ++column) {
    const double along = static_cast<double>(column) / static_cast<double>(edge.columns - 1);
    const double fold = std::sin(2.0 * kPi * settings.folds * along + phase_rad);
    edge.x_m[column] = static_cast<float>(setup.placement.x_m);
    edge.y_m[column] =
        static_cast<float>(setup.placement.y_m + settings.pole_height_m - pitch_m * static_cast<double>(column));
    edge.z_m[column] = static_cast<float>(setup.placement.z_m);
    const EastSouth lean = turned_by_heading(setup.placement, fold * lean_of_deg(settings.fold_angle_deg),
                                             -lean_of_deg(droop_at_deg(settings, along)));
    edge.lean_east[column] = static_cast<float>(lean.east);
    edge.lean_south[column] = static_cast<float>(lean.south);
  }
  return edge;
}

class Flag final : public Scene {
 public:
  Flag(const FlagSettings& settings, const Setup& setup) : Flag(flag_edge(settings, setup), settings, setup) {}

  const pose::Skeleton& skeleton() const noexcept override { return cloth_.skeleton(); }
  const pose::Pose& pose() const noexcept override { return cloth_.pose(); }

  double largest_joint_step_m(double dt_s) const noexcept override {
    const double lift_step = operators::OscillatorStep::largest_rate_per_s(lift_hz_, kFlagLiftDamping) * dt_s;
    const double noise_step = waves_.largest_change(kFastestWave_m_s, dt_s) +
                              edge_flutter_ * edge_waves_.largest_change(kFastestWave_m_s, dt_s) +
                              (1.0 + edge_flutter_) * ClothNoise::kLargest * ClothStrength::largest_step(dt_s);
    const double longest = operators::OscillatorStep::largest_gain(kFlagLiftDamping);
    return cloth_.largest_joint_step_m(
        dt_s, lift_step * (1.0 + 2.0 * longest_rest_) + longest * (1.0 + kLowerCurl) * flutter_rad_ * noise_step);
  }

  void shift(const wind::ground::Wind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    strength_.step(wind_.speed_m_s(), half_flutter_speed_m_s_, dt_s);
    const double speed_m_s = std::min(wave_speed_ * wind_.speed_m_s(), kFastestWave_m_s);
    waves_.shift(speed_m_s, dt_s);
    edge_waves_.shift(speed_m_s, dt_s);
  }

  void sample() noexcept override {
    waves_.sample();
    edge_waves_.sample();
  }

  void project(double dt_s) noexcept override {
    // The lift by the wind, as a downwind lean: tan(lift / 2), from tan(lift).
    const double speed_m_s = wind_.speed_m_s();
    const double s = speed_m_s / half_lift_speed_m_s_;
    const double tangent = s * s;
    const double half_tangent = tangent / (1.0 + std::sqrt(1.0 + tangent * tangent));
    const double per_speed = speed_m_s > 0.0 ? half_tangent / speed_m_s : 0.0;
    const operators::OscillatorStep step = operators::OscillatorStep::exact(lift_hz_, kFlagLiftDamping, dt_s);
    lift_east_.step(wind_.east_m_s() * per_speed, step);
    lift_south_.step(wind_.south_m_s() * per_speed, step);

    const auto east = static_cast<float>(lift_east_.value);
    const auto south = static_cast<float>(lift_south_.value);
    const auto strength = static_cast<float>(strength_.value());
    const float sway_share = cloth_.sway_share();
    const float wave_share = cloth_.wave_share();
    const std::size_t stride = cloth_.knots().stride;
    const std::span<float> lean = cloth_.lean();
    const std::size_t edge_begins = cloth_.knots().links - edge_rad_.size();
    for (std::size_t link = 0; link < cloth_.knots().links; ++link) {
      const std::span<const float> wave = waves_.values().subspan(link * stride, stride);
      for (std::size_t i = 0; i < stride; ++i) angle_rad_[i] = wave_rad_[link] * strength * wave[i];
      if (link >= edge_begins) {
        const std::size_t row = link - edge_begins;
        const std::span<const float> edge_wave = edge_waves_.values().subspan(row * stride, stride);
        for (std::size_t i = 0; i < stride; ++i) {
          angle_rad_[i] = (angle_rad_[i] + edge_rad_[row] * strength * edge_wave[i]) * (1.0F + curl_[row] * corner_[i]);
        }
      }
      float* const lean_east = lean.data() + link * 2 * stride;
      float* const lean_south = lean_east + stride;
      for (std::size_t i = 0; i < stride; ++i) {
        const auto [sine, cosine] = math::sin_cos(angle_rad_[i]);
        const float ahead = sway_share + wave_share * (cosine - 1.0F);
        const float aside = wave_share * sine;
        lean_east[i] = ahead * east - aside * south;
        lean_south[i] = ahead * south + aside * east;
      }
    }

    // It loses its droop and its folds as it is lifted, by the square of the lift's cosine.
    const double square = lift_east_.value * lift_east_.value + lift_south_.value * lift_south_.value;
    const double cosine = (1.0 - square) / (1.0 + square);
    for (std::size_t i = 0; i < stride; ++i)
      gusts_[i] = waves_.values()[i] * static_cast<float>(1.0 / ClothNoise::kLargest);
    cloth_.blow(wind_.east_m_s(), wind_.south_m_s(), gusts_);
    cloth_.project(dt_s, cosine * cosine);
  }

  void list_state(StatePass& pass) override {
    pass(wind_, strength_, lift_east_, lift_south_, cloth_, waves_, edge_waves_);
  }

 private:
  /// An oscillator on one axis: OscillatorStep's.
  struct Lift {
    double value = 0.0;
    double rate_per_s = 0.0;

    void step(double target, const operators::OscillatorStep& step) noexcept {
      constexpr double kAtRest = 1e-9;
      const double distance = value - target;
      value = target + step.q_from_e * distance + step.q_from_v * rate_per_s;
      rate_per_s = step.v_from_e * distance + step.v_from_v * rate_per_s;
      if (std::abs(value) + std::abs(rate_per_s) < kAtRest) *this = {};
    }

    void list_state(StatePass& pass) { pass(value, rate_per_s); }
  };

  Flag(const ClothEdge& edge, const FlagSettings& settings, const Setup& setup)
      : half_lift_speed_m_s_(settings.half_lift_speed_m_s),
        lift_hz_(settings.lift_rate_hz),
        flutter_rad_(settings.max_flutter_deg / ClothNoise::kLargest * kRadPerDeg),
        half_flutter_speed_m_s_(settings.half_flutter_speed_m_s),
        wave_speed_(settings.wave_speed),
        edge_flutter_(settings.edge_flutter),
        longest_rest_(math::length(lean_of_deg(droop_at_deg(settings, 1.0)), lean_of_deg(settings.fold_angle_deg))),
        wind_(setup.placement, setup.gusts),
        cloth_(flag_spec(settings), edge, setup.row),
        down_m_(heights_m(cloth_, settings.hoist_m)),
        waves_(settings.wave_length_m / kFlagBand, settings.wave_length_m, wave_grid(settings, 0.0),
               setup.seed ^ math::stream_id("flag noise"), setup.row),
        edge_waves_(kFlagEdgeWaves * settings.wave_length_m / kFlagBand, kFlagEdgeWaves * settings.wave_length_m,
                    wave_grid(settings, kFlagEdgeBegins), setup.seed ^ math::stream_id("flag edge noise"), setup.row),
        corner_(corners(cloth_)),
        angle_rad_(cloth_.knots().stride),
        gusts_(cloth_.knots().stride) {
    for (std::size_t link = 0; link < cloth_.knots().links; ++link) {
      const double along = cloth_.along(link);
      wave_rad_.push_back(static_cast<float>(flutter_rad_ * std::pow(along, settings.growth)));
      if (along < kFlagEdgeBegins) continue;
      const double curled = std::max(along - kCurlBegins, 0.0) / (1.0 - kCurlBegins);
      curl_.push_back(static_cast<float>(curled * curled));
      edge_rad_.push_back(
          static_cast<float>(flutter_rad_ * edge_flutter_ * (along - kFlagEdgeBegins) / (1.0 - kFlagEdgeBegins)));
    }
  }

  /// How much each knot column curls at the fly: the lower corner and the upper.
  static std::vector<float> corners(const Cloth& cloth) {
    std::vector<float> curl;
    for (std::size_t i = 0; i < cloth.knots().stride; ++i) {
      const double beside = 2.0 * std::clamp(cloth.across(i), 0.0, 1.0) - 1.0;
      curl.push_back(static_cast<float>((beside > 0.0 ? kLowerCurl : kUpperCurl) * beside * beside));
    }
    return curl;
  }

  /// Each knot column's distance below the top, for reading the noise.
  static std::vector<float> heights_m(const Cloth& cloth, double hoist_m) {
    std::vector<float> down_m;
    for (std::size_t i = 0; i < cloth.knots().stride; ++i) {
      down_m.push_back(static_cast<float>(kHeightOnNoise * cloth.across(i) * hoist_m));
    }
    return down_m;
  }

  /// The knots from `begins` on, which is a part of the length.
  ClothWaveGrid wave_grid(const FlagSettings& settings, double begins) const {
    std::size_t first = 0;
    while (cloth_.along(first) < begins) ++first;
    const double length_m = settings.length_m;
    return {.first_m = cloth_.along(first) * length_m,
            .step_m = length_m / static_cast<double>(cloth_.knots().links),
            .rows = cloth_.knots().links - first,
            .across_m = down_m_,
            .slant = kFoldSlant / kHeightOnNoise};
  }

  double half_lift_speed_m_s_;
  double lift_hz_;
  double flutter_rad_;  ///< turn of the fly to the sides, for a wave of height 1
  double half_flutter_speed_m_s_;
  double wave_speed_;  ///< over the wind's
  double edge_flutter_;
  double longest_rest_;  ///< lean at rest

  Wind wind_;
  ClothStrength strength_;
  Lift lift_east_, lift_south_;  ///< leans
  Cloth cloth_;
  std::vector<float> down_m_;
  ClothWaves waves_, edge_waves_;           ///< of all knots, and of those near the fly
  std::vector<float> wave_rad_, edge_rad_;  ///< each knot link's, of waves of height 1 at full strength
  std::vector<float> corner_, curl_;        ///< of each knot column, and of each of the links near the fly
  std::vector<float> angle_rad_;
  std::vector<float> gusts_;
};

const std::array kRetiredFlagParameters = {
    RetiredParameter{"max_lift", "is now half_lift_speed: a storm lifts a flag as far as its weight lets it"},
    RetiredParameter{"quickness", "is now lift_rate, in Hz: how fast the flag swings back"},
    RetiredParameter{"travel_time", "is now wave_speed: waves run to the fly at a part of the wind's speed"},
    RetiredParameter{"tile_period", "is now wave_length, of the longest waves"},
    RetiredParameter{"beta", "is gone: waves are a band of lengths, see wave_length"},
};

}  // namespace

extern const Description kFlagScene;
const Description kFlagScene = {
    .name = "flag",
    .summary = "a flag that hangs limp in calm air, and flies downwind of its pole",
    .parameters = kFlagFields.parameters(),
    .make =
        [](const ParameterValues& values, const Setup& setup) {
          return std::unique_ptr<Scene>(std::make_unique<Flag>(kFlagFields.of(values), setup));
        },
    .retired = kRetiredFlagParameters};

}  // namespace yuragi::scenes
