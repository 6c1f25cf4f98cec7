#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/math/critically_damped.hpp"
#include "engine/math/philox.hpp"
#include "engine/noise/von_karman_corner.hpp"
#include "engine/operators/displacement_job.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/carried_noise.hpp"
#include "engine/scenes/layered_noise.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/rough_water.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"
#include "engine/scenes/wind_grid.hpp"

// Ripples on water (Chiba, section 2-2: displacement): a surface whose points shifted noise moves along their normals.
//
//   shift    two fields of waves go downwind at their own speed, to either side of the wind, so that   LayeredNoise
//            their sum changes as it goes; how steep the water is follows the wind over each place     RoughWater
//   sample   the waves at each point, and how steep they are there                                     (both)
//   project  each point moves along its normal, as far as makes waves so steep                         DisplacementJob
//
// In calm air the water is flat. From about 1 m/s on the variance of its slope is that which was measured on the sea
// (Cox and Munk 1954), or a part of it, for a grid does not hold the finest waves: its height grows as the root of the
// wind. Where a gust touches the water it is steeper, mirrors less of the low, bright sky, and is darker: a cat's paw.
//
// Short waves come first, long ones with the wind: from 1 to 8 m/s the variance goes over from the short field to the
// long one.

namespace yuragi::scenes {
namespace {

constexpr std::size_t kWaveSamples = 512;
constexpr double kWavesPerTile = 16.0;  ///< so a wave has 32 samples

/// Maximum length of a wave, relative to the strongest: a longer one would go faster than its field.
constexpr double kLongest = 1.5;

/// The two finest octaves are omitted, which are shorter than a sixth of a wave. They would be too fine for the grid,
/// and would show the samples; the rest is slow enough for the ticks (|k| U < pi rate from wave_length 0.1 m on).
constexpr std::size_t kWaveBand = 2;

constexpr double kGravity_m_s2 = 9.81;
constexpr double kTension_m3_s2 = 7.3e-5;  ///< of clean water, over its density

/// The second field of waves is shorter than the first.
constexpr double kShorter = 1.0 / std::numbers::phi;

/// The directions of the two fields, 25 degrees to either side of the wind: cosine and sine.
constexpr double kCrossingCos = 0x1.d0079302dd767p-1;
constexpr double kCrossingSin = 0x1.b0c2d77379853p-2;

/// Below this wind (m/s) waves slow down, so that calm air needs no direction.
constexpr double kSlow_m_s = 0.5;

/// Minimum spacing of the nodes at which the water gets the wind.
constexpr double kFinestCell_m = 0.5;

/// The long field's part of the height's variance, at this wind.
constexpr double kShortWind_m_s = 1.0;
constexpr double kLongWind_m_s = 8.0;
constexpr double kMinLong = 0.2;
constexpr double kMaxLong = 0.8;

/// The water's own gusts, for a wind without gusts: their standard deviation, relative to the wind.
constexpr double kOwnGusts = 0.2;

/// kRippleFields defines each.
struct RippleSettings {
  std::size_t columns;
  std::size_t rows;
  double width_m;
  double depth_m;
  double steepness;
  double wave_length_m;
  double onset_m_s;
  double gustiness;
  double beta;
};

const Fields<RippleSettings> kRippleFields = {
    {{"columns", "", std::int64_t{200}, 2, 1000, "points from west to east"}, &RippleSettings::columns},
    {{"rows", "", std::int64_t{200}, 2, 1000, "points from north to south"}, &RippleSettings::rows},
    {{"width", "m", 8.0, 0.1, 200, "the water from west to east"}, &RippleSettings::width_m},
    {{"depth", "m", 8.0, 0.1, 200, "the water from north to south"}, &RippleSettings::depth_m},
    {{"steepness", "", 0.6, 0, 3,
      "of the waves: the variance of their slope, as a part of the sea's: 0.6 leaves out the finest, which the "
      "grid cannot hold; more is choppier"},
     &RippleSettings::steepness},
    {{"wave_length", "m", 1.2, 0.3, 100, "of the strongest waves; it sets their speed too, as on deep water"},
     &RippleSettings::wave_length_m},
    {{"onset", "m/s", 1.2, 0.1, 20, "the wind that raises the first ripples: a weaker one leaves a mirror"},
     &RippleSettings::onset_m_s},
    {{"gustiness", "", 1.0, 0, 3,
      "how much darker and rougher the water is under a gust: 1 as in nature, 0 the same everywhere"},
     &RippleSettings::gustiness},
    {{"beta", "", 4.0, 2, 6, "exponent of the waves' spectrum beyond the strongest: less is rougher"},
     &RippleSettings::beta},
};

constexpr std::array kRetiredRippleParameters = {
    RetiredParameter{"height", "is now steepness: the variance of the slope, as a part of the sea's"},
    RetiredParameter{"half_speed", "is now onset: the wind that raises the first ripples"},
};

/// A level grid around the world's origin, rows along x from north to south.
pose::SurfaceSkeleton level_water(const RippleSettings& settings, std::size_t columns, std::size_t rows) {
  pose::SurfaceSkeleton water;
  water.columns = columns;
  water.rows = rows;
  const auto at = [](std::size_t index, std::size_t count, double extent_m) {
    return static_cast<float>((static_cast<double>(index) / static_cast<double>(count - 1) - 0.5) * extent_m);
  };
  for (std::size_t row = 0; row < water.rows; ++row) {
    for (std::size_t column = 0; column < water.columns; ++column) {
      water.rest_x_m.push_back(at(column, water.columns, settings.width_m));
      water.rest_z_m.push_back(at(row, water.rows, settings.depth_m));
    }
  }
  const std::size_t count = water.rest_x_m.size();
  water.rest_y_m.assign(count, 0.0F);
  water.normal_x.assign(count, 0.0F);
  water.normal_y.assign(count, 1.0F);
  water.normal_z.assign(count, 0.0F);
  return water;
}

pose::SurfaceSkeleton placed_water(const RippleSettings& settings, std::size_t columns, std::size_t rows,
                                   const Placement& placement) {
  pose::SurfaceSkeleton water = level_water(settings, columns, rows);
  place(placement, water);
  return water;
}

RoughWaterSpec roughness_of(const RippleSettings& settings) {
  return {.columns = settings.columns,
          .rows = settings.rows,
          .width_m = settings.width_m,
          .depth_m = settings.depth_m,
          .finest_cell_m = kFinestCell_m,
          .part = settings.steepness,
          .onset_m_s = settings.onset_m_s};
}

/// The speed of waves on deep water, by gravity and surface tension.
double wave_speed(double length_m) {
  const double per_rad_m = length_m / (2.0 * std::numbers::pi);
  return std::sqrt(kGravity_m_s2 * per_rad_m + kTension_m3_s2 / per_rad_m);
}

double square_of(double value) {
  return value * value;
}

/// The two fields. Waves shorter than the strongest one, of length wave_length, fall as 1/f^beta, and longer ones are
/// weak: in two dimensions von Karman's spectrum of scale L has most power in the ring of wavelength 2 pi sqrt(beta)
/// 1.339 L.
std::array<NoiseLayerSpec, 2> wave_layers(const RippleSettings& settings, std::uint64_t seed) {
  const double beta = settings.beta;
  const double period_m = kWavesPerTile * settings.wave_length_m;
  const double scale = 1.0 / (kWavesPerTile * 2.0 * std::numbers::pi * std::sqrt(beta) * noise::kVonKarmanCorner);
  const auto waves = [&](std::uint64_t which) {
    return noise::Spec{.size = kWaveSamples,
                       .beta = beta,
                       .seed = seed ^ which,
                       .integral_scale = scale,
                       .from_cycles = kWavesPerTile / kLongest};
  };
  return {
      {{waves(math::stream_id("ripple waves")), period_m, period_m, 1.0F, kWaveBand},
       {waves(math::stream_id("ripple crossing waves")), kShorter * period_m, kShorter * period_m, 1.0F, kWaveBand}}};
}

class Ripple final : public Scene {
 public:
  Ripple(const RippleSettings& settings, const Setup& setup)
      : Ripple(placed_water(settings, settings.columns, settings.rows, setup.placement), settings, setup) {}

  const pose::Skeleton& skeleton() const noexcept override { return skeleton_; }
  const pose::Pose& pose() const noexcept override { return pose_; }

  void shift(const wind::ground::Wind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    const double east_m_s = wind_.east_m_s();
    const double south_m_s = wind_.south_m_s();

    // Waves move at their own speed, the two fields to either side of the wind.
    const double square = east_m_s * east_m_s + south_m_s * south_m_s;
    const double speed_per_wind = 1.0 / std::sqrt(square + kSlow_m_s * kSlow_m_s);
    for (std::size_t i = 0; i < 2; ++i) {
      const double way = wave_speed_m_s_[i] * speed_per_wind * dt_s;
      const double sine = i == 0 ? kCrossingSin : -kCrossingSin;
      waves_.shift(i, way * (kCrossingCos * east_m_s - sine * south_m_s),
                   way * (sine * east_m_s + kCrossingCos * south_m_s));
    }
    const double speed_m_s = std::sqrt(square);
    const double longer = std::clamp((speed_m_s - kShortWind_m_s) / (kLongWind_m_s - kShortWind_m_s), 0.0, 1.0);
    long_part_.step(longer, RoughWater::kBuildUp_rad_s, dt_s);
    if (outside_) {
      outside_->step(wind, dt_s);
      feel_gusts_outside();
    } else {
      gusts_.shift(east_m_s, south_m_s, dt_s);
      gusts_.sample(gust_places_, row_, node_wind_m_s_, static_cast<float>(kOwnGusts * gustiness_ * speed_m_s),
                    static_cast<float>(speed_m_s), 0.0F);
    }
    rough_.step(node_wind_m_s_, dt_s);
  }

  void sample() noexcept override {
    const double long_part = kMinLong + (kMaxLong - kMinLong) * long_part_.value;
    waves_.set_weight(0, static_cast<float>(std::sqrt(long_part)));
    waves_.set_weight(1, static_cast<float>(std::sqrt(1.0 - long_part)));
    height_per_slope_m_ = 1.0 / std::sqrt(long_part * square_of(waves_.slope_rms_per_m(0)) +
                                          (1.0 - long_part) * square_of(waves_.slope_rms_per_m(1)));
    waves_.sample(row_, noise_);
    rough_.sample(row_, slope_);
  }

  void project(double /*dt_s*/) noexcept override {
    operators::DisplacementJob{.noise = noise_,
                               .share = slope_,
                               .amplitude_m = height_per_slope_m_,
                               .row = row_,
                               .displacement_m = std::get_if<pose::SurfacePose>(&pose_)->displacement_m}
        .run();
  }

  /// A point is moved by slope noise / k, where the noise is the sum of w_i n_i, w_i^2 being the parts p and 1 - p of
  /// its variance, and k^2 = p k_1^2 + (1 - p) k_2^2: at least k_1^2, of the long field. In a tick the slope changes as
  /// in RoughWater; the waves by their movement at their own speed; p by d = 0.6 w dt / e, and with it each w_i by at
  /// most d / (2 sqrt(0.2)), and 1 / k by at most d (k_2^2 - k_1^2) / (2 k_1^3). Each is multiplied by the maximum of
  /// the others.
  double largest_joint_step_m(double dt_s) const noexcept override {
    const double largest_wave = std::max(waves_.highest(), -waves_.lowest());
    const double followed = std::min(RoughWater::kBuildUp_rad_s * dt_s / std::numbers::e, 1.0);
    const double part_step = (kMaxLong - kMinLong) * followed;
    double wave_step = part_step / (2.0 * std::sqrt(kMinLong)) * largest_wave;
    for (std::size_t i = 0; i < 2; ++i) {
      wave_step += waves_.largest_change(i, wave_speed_m_s_[i] * dt_s, wave_speed_m_s_[i] * dt_s);
    }
    const double long_per_m = waves_.slope_rms_per_m(0);
    const double short_per_m = waves_.slope_rms_per_m(1);
    const double height_step_m = part_step * std::abs(square_of(short_per_m) - square_of(long_per_m)) /
                                 (2.0 * long_per_m * square_of(long_per_m));
    return rough_.largest_slope() * ((followed * largest_wave + wave_step) / long_per_m + height_step_m * largest_wave);
  }

  void list_state(StatePass& pass) override {
    pass(wind_, long_part_, waves_, gusts_, rough_);
    if (outside_) pass(*outside_);
  }

 private:
  Ripple(pose::SurfaceSkeleton water, const RippleSettings& settings, const Setup& setup)
      : row_(setup.row),
        gustiness_(settings.gustiness),
        wave_speed_m_s_{wave_speed(settings.wave_length_m), wave_speed(kShorter * settings.wave_length_m)},
        wind_(setup.placement, nullptr, setup.gusts ? WindPart::kMean : WindPart::kAll),
        waves_(wave_layers(settings, setup.seed), water.rest_x_m, water.rest_z_m, water.columns),
        gusts_({.has_two_tiles = false, .seed = setup.seed ^ math::stream_id("ripple gusts")}),
        rough_(roughness_of(settings)),
        noise_(water.rest_x_m.size(), 0.0F),
        slope_(water.rest_x_m.size(), 0.0F),
        skeleton_(std::move(water)),
        pose_(pose::rest_pose(skeleton_)) {
    const pose::SurfaceSkeleton nodes =
        placed_water(settings, rough_.node_columns(), rough_.node_rows(), setup.placement);
    const std::size_t count = nodes.rest_x_m.size();
    node_wind_m_s_.assign(count, 0.0F);
    if (setup.gusts) {
      outside_.emplace(setup.gusts, nodes.rest_x_m, nodes.rest_z_m, setup.row, kFinestCell_m, nodes.columns);
      node_east_m_s_.assign(count, 0.0F);
      node_south_m_s_.assign(count, 0.0F);
    } else {
      gust_places_ = gusts_.places(nodes.rest_x_m, nodes.rest_z_m);
    }
  }

  /// The wind over each node: the mean, and `gustiness` times the rest of the wind there.
  void feel_gusts_outside() noexcept {
    outside_->sample(0, node_east_m_s_, node_south_m_s_);
    const auto part = static_cast<float>(gustiness_);
    const auto east_m_s = static_cast<float>(wind_.east_m_s());
    const auto south_m_s = static_cast<float>(wind_.south_m_s());
    for (std::size_t i = 0; i < node_wind_m_s_.size(); ++i) {
      const float here_east_m_s = east_m_s + part * (node_east_m_s_[i] - east_m_s);
      const float here_south_m_s = south_m_s + part * (node_south_m_s_[i] - south_m_s);
      node_wind_m_s_[i] = std::sqrt(here_east_m_s * here_east_m_s + here_south_m_s * here_south_m_s);
    }
  }

  SimdRow row_;
  double gustiness_;
  std::array<double, 2> wave_speed_m_s_;

  Wind wind_;
  math::CriticallyDamped long_part_;  ///< from 0, as in a light wind, to 1
  LayeredNoise waves_;                ///< the long field and the short one
  CarriedNoise gusts_;                ///< of its own
  CarriedPlaces gust_places_;
  std::optional<WindGrid> outside_;  ///< and the wind outside over the nodes, if there is one
  RoughWater rough_;
  std::vector<float> node_wind_m_s_, node_east_m_s_, node_south_m_s_;  ///< one per node of rough_
  double height_per_slope_m_ = 0.0;
  std::vector<float> noise_, slope_;  ///< a point each
  pose::Skeleton skeleton_;
  pose::Pose pose_;
};

}  // namespace

extern const Description kRippleScene;
const Description kRippleScene = {
    .name = "ripple",
    .summary = "water under the wind: waves rise, and gusts roughen it as they pass",
    .parameters = kRippleFields.parameters(),
    .make =
        [](const ParameterValues& values, const Setup& setup) {
          return std::unique_ptr<Scene>(std::make_unique<Ripple>(kRippleFields.of(values), setup));
        },
    .retired = kRetiredRippleParameters};

}  // namespace yuragi::scenes
