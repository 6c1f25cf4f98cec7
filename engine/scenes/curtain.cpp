#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/operators/propagation_job.hpp"
#include "engine/scenes/cloth.hpp"
#include "engine/scenes/cloth_noise.hpp"
#include "engine/scenes/cloth_parameters.hpp"
#include "engine/scenes/cloth_strength.hpp"
#include "engine/scenes/cloth_swing.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"

// A curtain in the wind, after N. Chiba, "Development of core technology for a noise-based real-time animation engine
// for fluctuation phenomena" (Iwate University), section 3.2 and figures 9 and 10:
//
//   shift    the wind carries two 2-D noises over the ground, and so along the curtain           ShiftJob
//   sample   each part of the curtain reads them where it hangs: gusts, and flutter of the hem   SampleJob
//   project  the wind blows each part out: the base sway;                                        Cloth
//            and the flutter propagates from the top to the hem, growing                         PropagationJob
//
// The wind's force is along the cloth's normal, q of the weight when it hangs: at an angle a to the vertical its normal
// part is q cos^2 a, that of the weight sin a, so that q cos^2 a = sin a (engine/METHOD.md M24). It blows the curtain
// out by P = tan a. Each column of the knots swings as a pendulum in a hanging chain's first two modes, 1.2024 sqrt(g /
// L) / 2 pi and the second 2.295 times as fast (D. Bernoulli 1733), both faster by (1 + P^2)^(1/4), since the wind
// raises the tension by sqrt(1 + P^2): so it swings on after a gust. Its hem is heavy: steep above, it hangs nearly
// upright at the hem. A wave runs down in 2 sqrt(L / g), sooner in a curtain that is blown out.
//
// In a breeze it breathes: of what the wind carries, bulges pass too quickly to swing it, but longer gusts come about
// as often as it swings, and fill and empty it as a whole. In a storm they, too, are too quick, and it stands taut.
//
// At rest it hangs in gathered folds that open a little toward the hem.
//
// The bound of largest_joint_step_m. The knots' P are within kMaxPull and change by at most r = kMaxPull_per_s
// dt a tick (ClothSwing's limits), P of both axes by at most sqrt(2) r. A lean T / (1 + sqrt(1 + T^2)) changes by at
// most half of what T does, and T by 0.8 of what P does. The flutter is S n: it changes by d = d_n + 2.2 d_S a tick
// (ClothNoise, ClothStrength), and its history no faster (propagation_history.hpp), but that the delay changes too:
// |d delay / dP| is at most 0.2155 of that in calm air, and P changes by r. It adds the flutter times w (1 + l^2), l
// the sway's lean, below 1, and w half the hem's angle. So a lean changes by at most
//   0.4 sqrt(2) r (1 + 2 * 2.2 w) + 2 w d (1 + 0.2155 delay kMaxPull_per_s).

namespace yuragi::scenes {
namespace {

/// kCurtainFields defines each.
struct CurtainSettings {
  std::size_t columns;
  std::size_t rows;
  double width_m;
  double height_m;
  double clearance_m;
  double folds;
  double fold_depth_m;
  double max_sway_deg;
  double half_sway_speed_m_s;
  double give_sideways;
  double bulges;
  double max_flutter_deg;
  double half_flutter_speed_m_s;
  double wave_length_m;
  double wave_speed;
  double damping;
  double hybrid;
};

const Fields<CurtainSettings> kCurtainFields = {
    {{"columns", "", std::int64_t{200}, 2, 4000, "threads from one side to the other"}, &CurtainSettings::columns},
    {{"rows", "", std::int64_t{150}, 2, 4000, "joints from the top to the hem"}, &CurtainSettings::rows},
    {{"width", "m", 3.0, 0.1, 100, "from one side to the other"}, &CurtainSettings::width_m},
    {{"height", "m", 2.4, 0.1, 50, "from the top to the hem; a longer one swings more slowly"},
     &CurtainSettings::height_m},
    {{"clearance", "m", 0.1, 0, 50, "between the hem and the ground"}, &CurtainSettings::clearance_m},
    {{"folds", "", 11.0, 0, 200, "folds that it is gathered in"}, &CurtainSettings::folds},
    {{"fold_depth", "m", 0.07, 0, 1, "of a fold, from crest to trough, at the top"}, &CurtainSettings::fold_depth_m},
    {{"max_sway", "deg", 75.0, 0, 75, "how far from straight down the strongest wind blows its upper part"},
     &CurtainSettings::max_sway_deg},
    {{"half_sway_speed", "m/s", 5.0, 0.1, 60, "the wind that blows it up to 45 degrees; heavier cloth needs more"},
     &CurtainSettings::half_sway_speed_m_s},
    {{"give_sideways", "", 0.25, 0, 1, "how far the cloth gives way along itself, as a part of that across"},
     &CurtainSettings::give_sideways},
    {{"bulges", "", 0.22, 0, 0.45,
      "how unequally gusts fill it, from place to place and in time; 0: it swings as a board"},
     &CurtainSettings::bulges},
    {{"max_flutter", "deg", 40.0, 0, 80, "how far the strongest wind makes the hem flutter about that"},
     &CurtainSettings::max_flutter_deg},
    {{"half_flutter_speed", "m/s", 3.6, 0.1, 60, "the wind that makes it flutter half as much"},
     &CurtainSettings::half_flutter_speed_m_s},
    {{"wave_length", "m", 2.0, 0.2, 100,
      "of the longest bulges; the hem's waves are somewhat shorter, and shorter ones pass faster"},
     &CurtainSettings::wave_length_m},
    {{"wave_speed", "", 0.36, 0, 1, "how fast bulges and waves pass, as a part of the wind's speed"},
     &CurtainSettings::wave_speed},
    {{"damping", "", 0.36, 0.01, 1, "how soon it hangs still again; 0.1: it swings on for long"},
     &CurtainSettings::damping},
    {{"hybrid", "", 0.0, 0, 1, "0: the noise alone; 1: dynamics of a coarse cloth, with the noise as detail"},
     &CurtainSettings::hybrid},
    kClothColor,
    kClothColor2,
    kClothImage,
};

constexpr double kCurtainGravity_m_s2 = 9.81;

/// The longest waves over the shortest, and those of the hem over the bulges.
constexpr double kCurtainBand = 3.0;
constexpr double kHemWaves = 0.6;

/// The longest gusts that it breathes with, relative to the longest bulges, the ratio of the longest to the shortest of
/// them, and how much they fill it at most, relative to bulges: when its flutter is a third of a storm's.
constexpr double kBreathWaves = 3.0;
constexpr double kBreathBand = 2.0;
constexpr double kBreath = 4.0;

/// A hanging chain's first frequency over sqrt(g / L) / 2 pi (half the first zero of the Bessel function J0), the ratio
/// of the second to the first, and the share of the second in a column's swing.
constexpr double kChainFirstMode = 1.2024127788478890;
constexpr double kChainSecondPerFirst = 2.2954172674276943;
constexpr double kSecondShare = 0.2;

/// Maximum tan(a) of a part of the curtain (78.7 degrees), and its maximum rate.
constexpr double kMaxPull = 5.0;
constexpr double kMaxPull_per_s = 20.0;

/// No wave passes faster: 0.1 m a tick, a quarter of the hem's shortest.
constexpr double kFastestCurtainWave_m_s = 6.0;

/// The hem's weight over that of the cloth: at s along the cloth, the part below has the weight (1 - s) of the cloth
/// plus the hem, and the wind acts on (1 - s) of it.
constexpr double kHemWeight = 0.25;

/// The share of the wind's force on its sides, past which it spills; the middle gets all of it.
constexpr double kSideForce = 0.75;

ClothSpec curtain_spec(const CurtainSettings& settings) {
  return {.rows = settings.rows,
          .length_m = settings.height_m,
          .knots_across_m = std::min(0.12, settings.wave_length_m / 16.0),
          .knots_along_m = settings.height_m / 24.0,
          .hybrid = settings.hybrid,
          .normal_drag_per_m = drag_per_m(settings.half_sway_speed_m_s),
          .skin_drag_per_m = 0.05 * drag_per_m(settings.half_sway_speed_m_s)};
}

/// The columns from west to east at a heading of 0, folded toward north and south.
ClothEdge curtain_edge(const CurtainSettings& settings, const Setup& setup) {
  ClothEdge edge(settings.columns);
  const double height_m = settings.height_m;
  const double depth_m = 0.5 * settings.fold_depth_m;
  const double pitch_m = settings.width_m / static_cast<double>(edge.columns - 1);
  const math::RandomStream random(setup.seed, math::stream_id("curtain folds"));
  const double first_phase_rad = 2.0 * kPi * random.uniform(0);
  const double second_phase_rad = 2.0 * kPi * random.uniform(1);
  for (std::size_t column = 0; column < edge.stride(); ++column) {
    // No two folds are equal: their phase and depth vary slowly along the curtain.
    const double along = static_cast<double>(column) / static_cast<double>(edge.columns - 1);
    const double stray = std::sin(2.0 * kPi * 1.7 * along + first_phase_rad);
    const double fold = std::sin(2.0 * kPi * settings.folds * along + 0.9 * stray + second_phase_rad) *
                        (1.0 + 0.25 * std::sin(2.0 * kPi * 2.9 * along + second_phase_rad));
    const EastSouth place = turned_by_heading(
        setup.placement, pitch_m * static_cast<double>(column) - 0.5 * settings.width_m, depth_m * fold);
    edge.x_m[column] = static_cast<float>(setup.placement.x_m + place.east);
    edge.y_m[column] = static_cast<float>(setup.placement.y_m + height_m + settings.clearance_m);
    edge.z_m[column] = static_cast<float>(setup.placement.z_m + place.south);

    // The hem's folds are deeper by a half.
    const EastSouth lean =
        turned_by_heading(setup.placement, 0.0, std::tan(0.5 * std::atan(0.5 * depth_m * fold / height_m)));
    edge.lean_east[column] = static_cast<float>(lean.east);
    edge.lean_south[column] = static_cast<float>(lean.south);
  }
  return edge;
}

class Curtain final : public Scene {
 public:
  Curtain(const CurtainSettings& settings, const Setup& setup)
      : Curtain(curtain_edge(settings, setup), settings, setup) {}

  const pose::Skeleton& skeleton() const noexcept override { return cloth_.skeleton(); }
  const pose::Pose& pose() const noexcept override { return cloth_.pose(); }

  double largest_joint_step_m(double dt_s) const noexcept override {
    const double pull_step = 0.4 * std::numbers::sqrt2 * kMaxPull_per_s * dt_s;
    const double flutter_step = hem_noise_.largest_change(kFastestCurtainWave_m_s, dt_s) +
                                ClothNoise::kLargest * ClothStrength::largest_step(dt_s);
    const double later = 1.0 + 0.2155 * calm_delay_s_ * kMaxPull_per_s;
    return cloth_.largest_joint_step_m(
        dt_s, pull_step * (1.0 + 2.0 * ClothNoise::kLargest * flutter_) + 2.0 * flutter_ * flutter_step * later);
  }

  void shift(const wind::ground::Wind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    strength_.step(wind_.speed_m_s(), half_flutter_speed_m_s_, dt_s);
    const double speed_m_s = wind_.speed_m_s();
    const double share =
        wave_speed_ * speed_m_s > kFastestCurtainWave_m_s ? kFastestCurtainWave_m_s / speed_m_s : wave_speed_;
    gust_noise_.shift(share * wind_.east_m_s(), share * wind_.south_m_s(), dt_s);
    breath_noise_.shift(share * wind_.east_m_s(), share * wind_.south_m_s(), dt_s);
    hem_noise_.shift(share * wind_.east_m_s(), share * wind_.south_m_s(), dt_s);
  }

  void sample() noexcept override {
    gust_noise_.sample(gust_places_, gust_);
    breath_noise_.sample(breath_places_, breath_);
    hem_noise_.sample(hem_places_, flutter_now_);
  }

  void project(double dt_s) noexcept override {
    // The wind that it gives way to, across and along it.
    const double across_m_s = wind_.south_m_s() * along_.east - wind_.east_m_s() * along_.south;
    const double along_m_s = give_sideways_ * (wind_.east_m_s() * along_.east + wind_.south_m_s() * along_.south);
    const double felt_m_s = std::sqrt(across_m_s * across_m_s + along_m_s * along_m_s);
    const double s = felt_m_s / half_sway_speed_m_s_;
    const double load = std::numbers::sqrt2 * s * s;
    const double per_speed = felt_m_s > 0.0 ? 1.0 / felt_m_s : 0.0;

    // Each part of it swings.
    const std::size_t stride = cloth_.knots().stride;
    const auto strength = static_cast<float>(strength_.value());
    const double yielding = 1.0 - strength_.value();
    const double breath = kBreath * 6.75 * yielding * yielding * strength_.value();
    double mean = 0.0;
    for (std::size_t i = 0; i < stride; ++i) {
      const double filled = static_cast<double>(gust_[i]) + breath * static_cast<double>(breath_[i]);
      const double target = side_[i] * across_m_s * per_speed * blown_out(load * std::max(1.0 + bulges_ * filled, 0.0));
      swing(first_[i], first_[i].value, target, first_hz_, dt_s);
      swing(second_[i], first_[i].value, target, kChainSecondPerFirst * first_hz_, dt_s);
      const double out = (1.0 - kSecondShare) * first_[i].value + kSecondShare * second_[i].value;
      out_[i] = static_cast<float>(out);
      mean += out / static_cast<double>(stride);
      flutter_now_[i] *= strength;
    }
    swing(sideways_, sideways_.value, along_m_s * per_speed * blown_out(load), first_hz_, dt_s);
    const auto sideways = static_cast<float>(sideways_.value);

    // The flutter runs down, faster if the wind tightens the cloth.
    history_.push(flutter_now_, dt_s);
    operators::PropagationJob{.history = &history_,
                              .base = still_,
                              .growth = growth_,
                              .travel_time_s = calm_delay_s_ / std::sqrt(std::sqrt(1.0 + mean * mean)),
                              .row = row_,
                              .out = flutter_down_}
        .run();

    const auto along_east = static_cast<float>(along_.east);
    const auto along_south = static_cast<float>(along_.south);
    const float sway_share = cloth_.sway_share();
    const float wave_share = cloth_.wave_share();
    const std::span<float> lean = cloth_.lean();
    for (std::size_t link = 0; link < cloth_.knots().links; ++link) {
      const float shape = shape_[link];
      const float* const flutter = flutter_down_.data() + link * stride;
      float* const lean_east = lean.data() + link * 2 * stride;
      float* const lean_south = lean_east + stride;
      for (std::size_t i = 0; i < stride; ++i) {
        const float out = shape * out_[i];
        const float side = shape * sideways;
        const float square = out * out + side * side;
        const float half = 1.0F / (1.0F + __builtin_sqrtf(1.0F + square));
        // A lean that grows by d turns its link by 2 d / (1 + lean^2).
        const float wave = wave_share * flutter[i] * (1.0F + half * half * square);
        const float lean_out = sway_share * half * out + wave;
        const float lean_side = sway_share * half * side;
        lean_east[i] = lean_side * along_east - lean_out * along_south;
        lean_south[i] = lean_side * along_south + lean_out * along_east;
      }
    }
    for (float& gust : gust_) gust *= static_cast<float>(1.0 / ClothNoise::kLargest);
    cloth_.blow(wind_.east_m_s(), wind_.south_m_s(), gust_);
    cloth_.project(dt_s);
  }

  void list_state(StatePass& pass) override {
    pass(wind_, strength_, gust_noise_, breath_noise_, hem_noise_, cloth_, first_, second_, sideways_, history_);
  }

 private:
  Curtain(const ClothEdge& edge, const CurtainSettings& settings, const Setup& setup)
      : row_(setup.row),
        half_sway_speed_m_s_(settings.half_sway_speed_m_s),
        give_sideways_(settings.give_sideways),
        largest_sine_(std::sin(settings.max_sway_deg * kRadPerDeg)),
        bulges_(settings.bulges),
        flutter_(0.5 * settings.max_flutter_deg / ClothNoise::kLargest * kRadPerDeg),
        half_flutter_speed_m_s_(settings.half_flutter_speed_m_s),
        wave_speed_(settings.wave_speed),
        damping_(settings.damping),
        first_hz_(kChainFirstMode * std::sqrt(kCurtainGravity_m_s2 / settings.height_m) / (2.0 * kPi)),
        calm_delay_s_(2.0 * std::sqrt(settings.height_m / kCurtainGravity_m_s2)),
        along_(turned_by_heading(setup.placement, 1.0, 0.0)),
        wind_(setup.placement, setup.gusts),
        gust_noise_(settings.wave_length_m / kCurtainBand, settings.wave_length_m,
                    setup.seed ^ math::stream_id("curtain gusts"), setup.row),
        breath_noise_(kBreathWaves * settings.wave_length_m / kBreathBand, kBreathWaves * settings.wave_length_m,
                      setup.seed ^ math::stream_id("curtain breath"), setup.row),
        hem_noise_(kHemWaves * settings.wave_length_m / kCurtainBand, kHemWaves * settings.wave_length_m,
                   setup.seed ^ math::stream_id("curtain noise"), setup.row),
        cloth_(curtain_spec(settings), edge, setup.row),
        gust_(cloth_.knots().stride),
        breath_(gust_.size()),
        flutter_now_(gust_.size()),
        out_(gust_.size()),
        first_(gust_.size()),
        second_(gust_.size()),
        still_(gust_.size()),
        history_(gust_.size(), calm_delay_s_),
        flutter_down_(cloth_.knots().size() / 2) {
    std::vector<float> x_m;
    std::vector<float> z_m;
    for (std::size_t i = 0; i < gust_.size(); ++i) {
      const EastSouth place = turned_by_heading(setup.placement, (cloth_.across(i) - 0.5) * settings.width_m, 0.0);
      x_m.push_back(static_cast<float>(setup.placement.x_m + place.east));
      z_m.push_back(static_cast<float>(setup.placement.z_m + place.south));
      side_.push_back(kSideForce + (1.0 - kSideForce) * std::sin(kPi * std::clamp(cloth_.across(i), 0.0, 1.0)));
    }
    gust_places_ = gust_noise_.places(x_m, z_m);
    breath_places_ = breath_noise_.places(x_m, z_m);
    hem_places_ = hem_noise_.places(x_m, z_m);
    for (std::size_t link = 0; link < cloth_.knots().links; ++link) {
      const double left = 1.0 - cloth_.along(link);
      shape_.push_back(static_cast<float>(left / (left + kHemWeight)));
      growth_.push_back(static_cast<float>(flutter_ * cloth_.along(link)));
    }
  }

  /// tan(a) of q cos^2 a = sin a, for q of at least 0.
  double blown_out(double load) const noexcept {
    const double sine = std::min(2.0 * load / (1.0 + std::sqrt(1.0 + 4.0 * load * load)), largest_sine_);
    return sine / std::sqrt(1.0 - sine * sine);
  }

  /// A larger `stretched` makes it swing faster.
  void swing(ClothSwing& part, double stretched, double target, double calm_hz, double dt_s) const noexcept {
    const double hz = calm_hz * std::sqrt(std::sqrt(1.0 + stretched * stretched));
    part.step(target, hz, 4.0 * kPi * hz * damping_, {kMaxPull, kMaxPull_per_s}, dt_s);
  }

  SimdRow row_;
  double half_sway_speed_m_s_;
  double give_sideways_;
  double largest_sine_;  ///< of the angle to which the wind blows it
  double bulges_;
  double flutter_;  ///< a lean: the hem's, for a wave of height 1
  double half_flutter_speed_m_s_;
  double wave_speed_;  ///< over the wind's
  double damping_;
  double first_hz_;      ///< in calm air
  double calm_delay_s_;  ///< from the top to the hem
  EastSouth along_;      ///< the curtain's own direction, from the first column to the last

  Wind wind_;
  ClothStrength strength_;
  ClothNoise gust_noise_, breath_noise_, hem_noise_;
  Cloth cloth_;
  CarriedPlaces gust_places_, breath_places_, hem_places_;
  std::vector<float> gust_, breath_, flutter_now_;  ///< each knot column's, like the next
  std::vector<float> out_;                          ///< how far it is blown out: a tangent
  std::vector<double> side_;                        ///< its share of the wind's force
  std::vector<ClothSwing> first_, second_;
  ClothSwing sideways_;
  std::vector<float> still_;
  operators::PropagationHistory history_;
  std::vector<float> growth_, shape_;  ///< each knot link's
  std::vector<float> flutter_down_;    ///< each knot's
};

const std::array kRetiredCurtainParameters = {
    RetiredParameter{"quickness", "is now damping: how soon the curtain swings out"},
    RetiredParameter{"travel_time", "was removed: the speed of the waves follows from the cloth's height and weight"},
    RetiredParameter{"tile_period", "is now wave_length, of the longest bulges"},
    RetiredParameter{"growth", "is gone: the hem's weight shapes the cloth"},
    RetiredParameter{"beta", "is gone: bulges are a band of lengths, see wave_length"},
};

}  // namespace

extern const Description kCurtainScene;
const Description kCurtainScene = {
    .name = "curtain",
    .summary = "a curtain that billows, and waves that run down and along it",
    .parameters = kCurtainFields.parameters(),
    .make =
        [](const ParameterValues& values, const Setup& setup) {
          return std::unique_ptr<Scene>(std::make_unique<Curtain>(kCurtainFields.of(values), setup));
        },
    .retired = kRetiredCurtainParameters};

}  // namespace yuragi::scenes
