#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/base/units.hpp"
#include "engine/math/critically_damped.hpp"
#include "engine/math/philox.hpp"
#include "engine/math/trig.hpp"
#include "engine/scenes/cloth.hpp"
#include "engine/scenes/cloth_parameters.hpp"
#include "engine/scenes/cloth_strength.hpp"
#include "engine/scenes/cloth_swing.hpp"
#include "engine/scenes/cloth_waves.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"

// A nobori, the tall banner of festivals and shop fronts, after N. Chiba, "Development of core technology for a
// noise-based real-time animation engine for fluctuation phenomena" (Iwate University), section 3.2 and figure 11:
//
//   shift    waves run down the banner, at a part of the wind's speed                                ShiftJob
//   sample   each part of the cloth reads them where it is                                           SampleJob
//   project  they turn the cloth to the sides, from the pole to the free side, and it hangs so       Cloth
//
// Row 0 hangs from the cross-arm, which with its pole is a vane: it turns downwind as a damped oscillator whose
// frequency goes with the wind, for its torque goes with the wind's square; in calm air it stays where it was left. The
// first column is on the pole and never moves. Held by both, the cloth cannot swing out as a whole: a wave turns it by
// an angle that grows from the pole to the free side and from the arm down, so that along each row it is the integral
// of that angle's sine that it goes to the side. Below, where only its loops hold it, the same wave turns it about the
// pole, as a door, so that its lower end swings also in a breeze. Threads hang from row to row and keep their length.
//
// The bound of largest_joint_step_m. A wave's angle A is g (A_w S n + 2 belly S c): it changes by at most
// d_A = A_w (d_n + 2.2 d_S) + 2 belly (d_S + d_c) a tick (ClothNoise, ClothStrength, CriticallyDamped for c, which is
// within 1), and counts by h, the hinge, at the pole and by 1 + h at the free side. A row's way to the side or back
// then changes by (1/2 + h) times the width times d_A at most; a knot's slope by
// sqrt(2) times twice that, over a knot's link; its lean by half as much as the slope. That is generous, since
// neighbouring rows go together. The arm turns by no more than kFastestTurn a second.

namespace yuragi::scenes {
namespace {

/// kBannerFields defines each.
struct BannerSettings {
  std::size_t columns;
  std::size_t rows;
  double width_m;
  double height_m;
  double clearance_m;
  bool turns;
  double belly;
  double max_flutter_deg;
  double half_flutter_speed_m_s;
  double wave_length_m;
  double wave_speed;
  double hybrid;
};

const Fields<BannerSettings> kBannerFields = {
    {{"columns", "", std::int64_t{64}, 2, 4000, "threads from the pole to the free side"}, &BannerSettings::columns},
    {{"rows", "", std::int64_t{256}, 2, 4000, "joints from the cross-arm down"}, &BannerSettings::rows},
    {{"width", "m", 0.6, 0.05, 20, "of the cloth"}, &BannerSettings::width_m},
    {{"height", "m", 2.7, 0.1, 50, "of the cloth"}, &BannerSettings::height_m},
    {{"clearance", "m", 0.5, 0, 50, "between the cloth and the ground"}, &BannerSettings::clearance_m},
    {{"turns", "", true, 0, 0, "the arm turns downwind, as a vane; if not, it points to the scene's east"},
     &BannerSettings::turns},
    {{"belly", "", 0.08, 0, 0.5, "how far a wind from the side bows the free side, as a part of the width"},
     &BannerSettings::belly},
    {{"max_flutter", "deg", 50.0, 0, 80, "how far the strongest waves turn the free side away from the pole's"},
     &BannerSettings::max_flutter_deg},
    {{"half_flutter_speed", "m/s", 2.8, 0.1, 60, "the wind that makes its waves half as high"},
     &BannerSettings::half_flutter_speed_m_s},
    {{"wave_length", "m", 2.4, 0.2, 100, "of the longest waves; shorter ones make it flutter faster"},
     &BannerSettings::wave_length_m},
    {{"wave_speed", "", 0.55, 0, 2, "how fast the waves run down, as a part of the wind's speed"},
     &BannerSettings::wave_speed},
    {{"hybrid", "", 0.0, 0, 1, "0: the noise alone; 1: dynamics of a coarse cloth, with the noise as detail"},
     &BannerSettings::hybrid},
    kClothColor,
    kClothColor2,
    kClothImage,
};

/// No wave runs faster: 0.2 m a tick.
constexpr double kFastestBannerWave_m_s = 12.0;

/// The longest waves over the shortest.
constexpr double kBannerBand = 2.0;

/// The lead of the waves at the free side, relative to its distance from the pole: a wave's front rises toward the free
/// side.
constexpr double kSlant = 0.35;

/// In the longest wave.
constexpr double kBannerKnotsAWave = 28.0;

/// The distance below the arm at which waves have half of their height, as a part of the banner's height (at most 0.4
/// of it if the lower end is free).
constexpr double kHeldByArm = 0.4;

/// The angle by which a wave turns the lower end about the pole, as a part of its further turn of the free side.
constexpr double kHinge = 0.6;

/// The vane: its frequency in a strong wind, the wind in which it turns half as fast, its damping, and friction.
constexpr double kArmHz = 0.5;
constexpr double kArmHalfSpeed_m_s = 0.5;
constexpr double kArmDamping = 0.7;
constexpr double kArmFriction_per_s = 1.0;
constexpr double kFastestTurn_rad_s = 5.0;

/// The wind that would hold it half way up if it hung by its arm alone: the hybrid's.
constexpr double kDragHalfSpeed_m_s = 4.5;

/// How quickly the belly changes over, and the sine of the wind's angle to the arm that fills it.
constexpr double kBellyOmega_rad_s = 2.0;
constexpr double kFullBelly = 0.2;

/// In the hybrid the cloth is taut from the pole to the free side, and by its loops the pole takes most of the wind.
ClothSpec banner_spec(const BannerSettings& settings) {
  return {.rows = settings.rows,
          .length_m = settings.height_m,
          .is_first_column_fixed = true,
          .knots_across_m = settings.width_m / 5.0,
          .knots_along_m = settings.wave_length_m / kBannerKnotsAWave,
          .hybrid = settings.hybrid,
          .normal_drag_per_m = 0.6 * drag_per_m(kDragHalfSpeed_m_s),
          .skin_drag_per_m = 0.05 * drag_per_m(kDragHalfSpeed_m_s),
          .across_stiffness_s2 = 6'000.0};
}

/// The pole is at the scene's origin, the cross-arm points to the scene's east.
ClothEdge banner_edge(const BannerSettings& settings, const Setup& setup) {
  ClothEdge edge(settings.columns);
  const double pitch_m = settings.width_m / static_cast<double>(edge.columns - 1);
  for (std::size_t column = 0; column < edge.stride(); ++column) {
    const EastSouth place = turned_by_heading(setup.placement, pitch_m * static_cast<double>(column), 0.0);
    edge.x_m[column] = static_cast<float>(setup.placement.x_m + place.east);
    edge.y_m[column] = static_cast<float>(setup.placement.y_m + settings.height_m + settings.clearance_m);
    edge.z_m[column] = static_cast<float>(setup.placement.z_m + place.south);
  }
  return edge;
}

class Banner final : public Scene {
 public:
  Banner(const BannerSettings& settings, const Setup& setup) : Banner(banner_edge(settings, setup), settings, setup) {}

  const pose::Skeleton& skeleton() const noexcept override { return cloth_.skeleton(); }
  const pose::Pose& pose() const noexcept override { return cloth_.pose(); }

  double largest_joint_step_m(double dt_s) const noexcept override {
    const double strength_step = ClothStrength::largest_step(dt_s);
    const double angle_step =
        flutter_rad_ * (waves_.largest_change(kFastestBannerWave_m_s, dt_s) + ClothNoise::kLargest * strength_step) +
        2.0 * belly_ * (strength_step + 2.0 * kBellyOmega_rad_s / std::numbers::e * dt_s);
    const double side_step_m = (0.5 + kHinge) * width_m_ * angle_step;
    return cloth_.largest_joint_step_m(dt_s, std::numbers::sqrt2 * side_step_m / knot_link_m_,
                                       turns_ ? kFastestTurn_rad_s * dt_s : 0.0);
  }

  void shift(const wind::ground::Wind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    strength_.step(wind_.speed_m_s(), half_flutter_speed_m_s_, dt_s);
    waves_.shift(std::min(wave_speed_ * wind_.speed_m_s(), kFastestBannerWave_m_s), dt_s);
  }
  void sample() noexcept override { waves_.sample(); }

  void project(double dt_s) noexcept override {
    turn_arm(dt_s);
    const auto strength = static_cast<float>(strength_.value());
    const auto bow = cloth_.sway_share() * static_cast<float>(2.0 * belly_ * cross_.value) * strength;
    const float wave = cloth_.wave_share() * static_cast<float>(flutter_rad_) * strength;

    // Each row of knots from the pole to the free side, then the part between it and the row before.
    const std::size_t stride = cloth_.knots().stride;
    const std::span<float> lean = cloth_.lean();
    const auto arm_east = static_cast<float>(arm_.east);
    const auto arm_south = static_cast<float>(arm_.south);
    for (std::size_t row = 0; row <= cloth_.knots().links; ++row) {
      std::swap(row_above_, row_here_);
      lay_out(row, bow, wave);
      if (row == 0) continue;
      float* const lean_east = lean.data() + (row - 1) * 2 * stride;
      float* const lean_south = lean_east + stride;
      for (std::size_t i = 0; i < from_pole_.size(); ++i) {
        const float ahead = per_link_m_ * (row_here_.ahead_m[i] - row_above_.ahead_m[i]);
        const float aside = per_link_m_ * (row_here_.aside_m[i] - row_above_.aside_m[i]);
        const float half = 1.0F / (1.0F + __builtin_sqrtf(1.0F + (ahead * ahead + aside * aside)));
        lean_east[i] = half * (ahead * arm_east - aside * arm_south);
        lean_south[i] = half * (ahead * arm_south + aside * arm_east);
      }
    }

    // The hybrid's cloth gets the air in its own frame, which turns with the arm.
    const auto [sine, cosine] = math::sin_cos(static_cast<float>(turned_rad_));
    const ClothTurn turn{static_cast<double>(sine), static_cast<double>(cosine)};
    std::fill(gusts_.begin(), gusts_.end(), waves_.values()[0] * static_cast<float>(1.0 / ClothNoise::kLargest));
    cloth_.blow(turn.cosine * wind_.east_m_s() + turn.sine * wind_.south_m_s(),
                turn.cosine * wind_.south_m_s() - turn.sine * wind_.east_m_s(), gusts_);
    cloth_.project(dt_s, 1.0, turn);
  }

  void list_state(StatePass& pass) override {
    pass(wind_, strength_, cloth_, waves_, cross_, vane_);
    pass.within(turned_rad_, -4.0, 4.0);
  }

 private:
  /// The positions of the knots of a row: along the arm, and beside it.
  struct Row {
    std::vector<float> ahead_m, aside_m;
  };

  Banner(const ClothEdge& edge, const BannerSettings& settings, const Setup& setup)
      : width_m_(settings.width_m),
        turns_(settings.turns),
        belly_(settings.belly),
        flutter_rad_(settings.max_flutter_deg / ClothNoise::kLargest * kRadPerDeg),
        half_flutter_speed_m_s_(settings.half_flutter_speed_m_s),
        wave_speed_(settings.wave_speed),
        arm_(turned_by_heading(setup.placement, 1.0, 0.0)),
        wind_(setup.placement, setup.gusts),
        cloth_(banner_spec(settings), edge, setup.row),
        knot_link_m_(settings.height_m / static_cast<double>(cloth_.knots().links)),
        per_link_m_(static_cast<float>(1.0 / knot_link_m_)),
        waves_(settings.wave_length_m / kBannerBand, settings.wave_length_m,
               {.first_m = 0.0,
                .step_m = knot_link_m_,
                .rows = cloth_.knots().links + 2 + static_cast<std::size_t>(kSlant * 2.0 * width_m_ / knot_link_m_),
                .across_m = kOneColumn},
               setup.seed ^ math::stream_id("banner noise"), setup.row),
        gusts_(cloth_.knots().stride),
        row_above_{gusts_, gusts_},
        row_here_{gusts_, gusts_} {
    for (std::size_t row = 0; row <= cloth_.knots().links; ++row) {
      const double down = static_cast<double>(row) / static_cast<double>(cloth_.knots().links);
      growth_.push_back(static_cast<float>((1.0 + kHeldByArm) * down / (down + kHeldByArm)));
      hinge_.push_back(static_cast<float>(kHinge * down * down));
    }
    for (std::size_t i = 0; i < cloth_.knots().columns + 2; ++i) {
      const double from_pole = std::max(cloth_.across(i), 0.0);
      const double rows = kSlant * from_pole * width_m_ / knot_link_m_;
      from_pole_.push_back(static_cast<float>(from_pole));
      ahead_rows_.push_back(static_cast<std::size_t>(rows));
      ahead_part_.push_back(static_cast<float>(rows - std::floor(rows)));
    }
  }

  /// Moves the vane, whose torque is proportional to the sine of half the angle, so that it turns back from any
  /// direction.
  void turn_arm(double dt_s) noexcept {
    const double speed_m_s = wind_.speed_m_s();
    const double per_speed_s_m = speed_m_s > 0.0 ? 1.0 / speed_m_s : 0.0;
    const double toward_east = wind_.east_m_s() * per_speed_s_m;
    const double toward_south = wind_.south_m_s() * per_speed_s_m;
    const auto [sine, cosine] = math::sin_cos(static_cast<float>(turned_rad_));
    const double arm_east = static_cast<double>(cosine) * arm_.east - static_cast<double>(sine) * arm_.south;
    const double arm_south = static_cast<double>(sine) * arm_.east + static_cast<double>(cosine) * arm_.south;
    const double ahead = arm_east * toward_east + arm_south * toward_south;
    const double aside = arm_east * toward_south - arm_south * toward_east;
    const double side = std::clamp(aside / kFullBelly, -1.0, 1.0);
    cross_.step(side, kBellyOmega_rad_s, dt_s);
    if (!(speed_m_s > 0.0) && std::abs(cross_.value) + std::abs(cross_.rate_per_s) < kAtRest) cross_ = {};
    if (!turns_) return;

    const double way_rad = speed_m_s > 0.0 ? std::copysign(std::sqrt(std::max(2.0 - 2.0 * ahead, 0.0)), aside) : 0.0;
    const double square = speed_m_s * speed_m_s;
    const double hz = kArmHz * square / (square + kArmHalfSpeed_m_s * kArmHalfSpeed_m_s);
    const double turn_rad_s =
        vane_.pull(way_rad, hz, 4.0 * kPi * hz * kArmDamping + kArmFriction_per_s, kFastestTurn_rad_s, dt_s);
    turned_rad_ += turn_rad_s * dt_s;
    if (turned_rad_ > kPi) turned_rad_ -= 2.0 * kPi;
    if (turned_rad_ < -kPi) turned_rad_ += 2.0 * kPi;
    if (!(speed_m_s > 0.0) && std::abs(vane_.rate_per_s) < kAtRest) vane_.rate_per_s = 0.0;
  }

  /// A row of knots: from the pole on, each step of the cloth is turned by the angle there.
  void lay_out(std::size_t row, float bow, float wave) noexcept {
    const float growth = growth_[row];
    const float hinge = hinge_[row];
    const float* const waves = waves_.values().data() + row;
    const auto half_step_m = static_cast<float>(0.5 * width_m_ / static_cast<double>(cloth_.knots().columns - 1));
    float ahead_m = 0.0F;
    float aside_m = 0.0F;
    math::SinCos<float> before = math::sin_cos(hinge * growth * (bow + wave * waves[0]));  // on the pole
    for (std::size_t i = 2; i < from_pole_.size(); ++i) {
      const float* const near = waves + ahead_rows_[i];
      const float noise = near[0] + ahead_part_[i] * (near[1] - near[0]);
      const auto here = math::sin_cos((hinge + from_pole_[i]) * growth * (bow + wave * noise));
      ahead_m += half_step_m * (before.cos + here.cos);
      aside_m += half_step_m * (before.sin + here.sin);
      row_here_.ahead_m[i] = ahead_m;
      row_here_.aside_m[i] = aside_m;
      before = here;
    }
  }

  static constexpr double kAtRest = 1e-9;
  static constexpr std::array kOneColumn = {0.0F};

  double width_m_;
  bool turns_;
  double belly_;        ///< over the width
  double flutter_rad_;  ///< turn of the free corner to the sides, for a wave of height 1
  double half_flutter_speed_m_s_;
  double wave_speed_;  ///< over the wind's
  EastSouth arm_;      ///< direction of the cross-arm at rest

  Wind wind_;
  ClothStrength strength_;
  Cloth cloth_;
  double knot_link_m_;
  float per_link_m_;
  ClothWaves waves_;                     ///< down the pole, and on
  std::vector<float> growth_, hinge_;    ///< for each row of joints between the knots' links
  std::vector<float> from_pole_;         ///< of each knot column: 0 on the pole, 1 at the free side
  std::vector<std::size_t> ahead_rows_;  ///< lead of the waves relative to the pole: rows, and part of the next
  std::vector<float> ahead_part_;
  std::vector<float> gusts_;
  Row row_above_, row_here_;

  math::CriticallyDamped cross_;  ///< -1 to 1: the side from which the wind fills the belly
  ClothSwing vane_;               ///< its rate alone
  double turned_rad_ = 0.0;       ///< of the arm, clockwise from rest
};

const std::array kRetiredBannerParameters = {
    RetiredParameter{"max_sway", "is now belly: how far a wind from the side bows the free side"},
    RetiredParameter{"half_sway_speed", "is now half_flutter_speed"},
    RetiredParameter{"travel_time", "is now wave_speed: waves run down at a part of the wind's speed"},
    RetiredParameter{"tile_period", "is now wave_length, of the longest waves"},
    RetiredParameter{"growth", "is gone: waves grow from the pole and from the arm"},
    RetiredParameter{"quickness", "is gone: the cloth follows its waves at once"},
    RetiredParameter{"beta", "is gone: waves are a band of lengths, see wave_length"},
};

}  // namespace

extern const Description kBannerScene;
const Description kBannerScene = {
    .name = "banner",
    .summary = "a nobori, held by its pole and cross-arm, that flutters in the wind",
    .parameters = kBannerFields.parameters(),
    .make =
        [](const ParameterValues& values, const Setup& setup) {
          return std::unique_ptr<Scene>(std::make_unique<Banner>(kBannerFields.of(values), setup));
        },
    .retired = kRetiredBannerParameters};

}  // namespace yuragi::scenes
