#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/math/critically_damped.hpp"
#include "engine/math/philox.hpp"
#include "engine/operators/displacement_job.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/carried_noise.hpp"
#include "engine/scenes/layered_noise.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"
#include "engine/scenes/wind_grid.hpp"

// Ripples on water (Chiba, section 2-2: displacement): a surface whose points shifted noise moves along their normals.
//
//   shift    two fields of waves go downwind at their own speed, to either side of the wind, so that      LayeredNoise
//            their sum changes as it goes; gusts go with the wind                                         CarriedNoise
//   sample   the waves at each point, and how hard the gust over it blows                                 (both)
//   project  each point moves along its normal, by an amplitude that the wind raises DisplacementJob
//
// In calm air the amplitude is 0 and the water flat. It follows height U^2 / (U^2 + half_speed^2), and takes its time,
// as waves do.

namespace yuragi {
namespace {

constexpr std::size_t kWaveSamples = 512;
constexpr double kWavesPerTile = 16.0;  ///< so a wave has 32 samples

/// Two octaves of the finest are left out: what is shorter than a sixth of a wave. It would be too fine for the grid,
/// and would show the samples; what is left goes slowly enough for the ticks (|k| U < pi rate from wave_length 0.1 m
/// on).
constexpr std::size_t kWaveBand = 2;

constexpr double kGravity_m_s2 = 9.81;

/// The second field of waves is shorter than the first.
constexpr double kShorter = 1.0 / std::numbers::phi;

/// 1 / sqrt(2): the variances of the two add up to 1.
constexpr float kHalfOfBoth = 0x1.6a09e6p-1F;

/// Where the two fields go, 25 degrees to either side of the wind: cosine and sine.
constexpr double kCrossingCos = 0x1.d0079302dd767p-1;
constexpr double kCrossingSin = 0x1.b0c2d77379853p-2;

/// How fast waves build up and die away.
constexpr double kBuildUp_rad_s = 1.5;

/// Below this wind (m/s) waves slow down, so that there is no direction to be known in calm air.
constexpr double kSlow_m_s = 0.5;

/// What is left of an amplitude that has died away: it moves nothing, and is not worth a denormal number.
constexpr double kFlat = 1e-12;

/// The gusts' own samples are as far apart.
constexpr double kFinestCell_m = 0.5;

/// Beyond it gusts from outside roughen the water no more, in standard deviations of a usual wind.
constexpr float kLargestGust = 3.0F;

const std::array kRippleParameters = {
    Parameter{"columns", "", std::int64_t{200}, 2, 1000, "points from west to east"},
    Parameter{"rows", "", std::int64_t{200}, 2, 1000, "points from north to south"},
    Parameter{"width", "m", 8.0, 0.1, 200, "the water from west to east"},
    Parameter{"depth", "m", 8.0, 0.1, 200, "the water from north to south"},
    Parameter{"height", "m", 0.04, 0, 2, "of the waves in the strongest wind: their standard deviation"},
    Parameter{"wave_length", "m", 1.2, 0.3, 100, "of the strongest waves; it sets their speed too, as on deep water"},
    Parameter{"half_speed", "m/s", 5.0, 0.1, 60, "the wind that raises waves to half their height"},
    Parameter{"gustiness", "", 0.35, 0, 2,
              "how much the waves differ where gusts pass: the gusts' standard deviation, as a part of the wind"},
    Parameter{"beta", "", 4.0, 2, 6, "exponent of the waves' spectrum beyond the strongest: less is rougher"},
};

/// A level grid around the world's origin, rows along x from north to south.
SurfaceSkeleton level_water(const ParameterValues& values) {
  SurfaceSkeleton water;
  water.columns = static_cast<std::size_t>(values.integer("columns"));
  water.rows = static_cast<std::size_t>(values.integer("rows"));
  const auto at = [](std::size_t index, std::size_t count, double extent_m) {
    return static_cast<float>((static_cast<double>(index) / static_cast<double>(count - 1) - 0.5) * extent_m);
  };
  for (std::size_t row = 0; row < water.rows; ++row) {
    for (std::size_t column = 0; column < water.columns; ++column) {
      water.rest_x_m.push_back(at(column, water.columns, values.number("width")));
      water.rest_z_m.push_back(at(row, water.rows, values.number("depth")));
    }
  }
  const std::size_t count = water.rest_x_m.size();
  water.rest_y_m.assign(count, 0.0F);
  water.normal_x.assign(count, 0.0F);
  water.normal_y.assign(count, 1.0F);
  water.normal_z.assign(count, 0.0F);
  return water;
}

SurfaceSkeleton placed_water(const ParameterValues& values, const ScenePlacement& placement) {
  SurfaceSkeleton water = level_water(values);
  place(placement, water);
  return water;
}

/// The two fields. Beyond the strongest wave, of length wave_length, their spectrum falls as 1/f^beta, and before it
/// there is little: in two dimensions von Karman's spectrum of scale L has most power in the ring of wavelength
/// 2 pi sqrt(beta) 1.339 L.
std::array<NoiseLayerSpec, 2> wave_layers(const ParameterValues& values, std::uint64_t seed) {
  const double beta = values.number("beta");
  const double period_m = kWavesPerTile * values.number("wave_length");
  const double scale = 1.0 / (kWavesPerTile * 2.0 * std::numbers::pi * std::sqrt(beta) * 1.339);
  const auto waves = [&](std::uint64_t which) {
    return NoiseSpec{.size = kWaveSamples, .beta = beta, .seed = seed ^ which, .integral_scale = scale};
  };
  return {
      {{waves(stream_id("ripple waves")), period_m, period_m, kHalfOfBoth, kWaveBand},
       {waves(stream_id("ripple crossing waves")), kShorter * period_m, kShorter * period_m, kHalfOfBoth, kWaveBand}}};
}

class Ripple final : public Scene {
 public:
  Ripple(const ParameterValues& values, const SceneSetup& setup)
      : Ripple(placed_water(values, setup.placement), values, setup) {}

  const Skeleton& skeleton() const noexcept override { return skeleton_; }
  const Pose& pose() const noexcept override { return pose_; }

  void shift(const GroundWind& wind, double dt_s) noexcept override {
    wind_.step(wind, dt_s);
    const double east_m_s = wind_.east_m_s();
    const double south_m_s = wind_.south_m_s();

    // Waves go at their own speed, the two fields to either side of the wind; gusts go with it.
    const double square = east_m_s * east_m_s + south_m_s * south_m_s;
    const double speed_per_wind = 1.0 / std::sqrt(square + kSlow_m_s * kSlow_m_s);
    for (std::size_t i = 0; i < 2; ++i) {
      const double way = wave_speed_m_s_[i] * speed_per_wind * dt_s;
      const double sine = i == 0 ? kCrossingSin : -kCrossingSin;
      waves_.shift(i, way * (kCrossingCos * east_m_s - sine * south_m_s),
                   way * (sine * east_m_s + kCrossingCos * south_m_s));
    }
    if (outside_) {
      outside_->step(wind, dt_s);
    } else {
      gusts_.shift(east_m_s, south_m_s, dt_s);
    }
  }

  void sample() noexcept override {
    waves_.sample(row_, noise_);
    if (!outside_) {
      gusts_.sample(gust_places_, row_, share_, static_cast<float>(gustiness_), 1.0F, 0.0F);
      return;
    }
    outside_->sample_gusts(0, share_, kLargestGust);
    for (float& share : share_) share = std::max(1.0F + static_cast<float>(gustiness_) * share, 0.0F);
  }

  void project(double dt_s) noexcept override {
    // The wind raises the waves.
    const double square = wind_.speed_m_s() * wind_.speed_m_s();
    amplitude_m_.step(height_m_ * square / (square + half_speed_m_s_ * half_speed_m_s_), kBuildUp_rad_s, dt_s);
    if (square == 0.0 && amplitude_m_.value < kFlat && std::abs(amplitude_m_.rate_per_s) < kFlat) amplitude_m_ = {};
    DisplacementJob{.noise = noise_,
                    .share = share_,
                    .amplitude_m = amplitude_m_.value,
                    .row = row_,
                    .displacement_m = std::get_if<SurfacePose>(&pose_)->displacement_m}
        .run();
  }

  /// A point is moved by amplitude * share * waves. In a tick the amplitude, which follows a target from 0 to height,
  /// changes by at most height w dt / e (CriticallyDamped); the gusts by what the strongest wind carries past; the
  /// waves by what goes past at their own speed. Each times the others at their largest.
  double largest_joint_step_m(double dt_s) const noexcept override {
    const double largest_wave = std::max(waves_.highest(), -waves_.lowest());
    const double largest_gust = outside_ ? static_cast<double>(kLargestGust) : std::max(gusts_.highest(), 0.0);
    const double largest_share = 1.0 + gustiness_ * largest_gust;
    double wave_step = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      wave_step += waves_.largest_change(i, wave_speed_m_s_[i] * dt_s, wave_speed_m_s_[i] * dt_s);
    }
    const double gust_step =
        outside_ ? 2.0 * largest_gust
                 : gusts_.largest_change(kStrongestSceneWind_m_s, SceneWind::largest_step_m_s(dt_s), dt_s);
    const double share_step = std::min(gustiness_ * gust_step, largest_share);
    const double amplitude_step = std::min(kBuildUp_rad_s * dt_s / std::numbers::e, 1.0);
    return height_m_ *
           (amplitude_step * largest_share * largest_wave + share_step * largest_wave + largest_share * wave_step);
  }

 private:
  Ripple(SurfaceSkeleton water, const ParameterValues& values, const SceneSetup& setup)
      : row_(setup.row),
        height_m_(values.number("height")),
        half_speed_m_s_(values.number("half_speed")),
        gustiness_(values.number("gustiness")),
        wind_(setup.placement, nullptr, setup.gusts ? WindPart::kMean : WindPart::kAll),
        waves_(wave_layers(values, setup.seed), water.rest_x_m, water.rest_z_m, water.columns),
        gusts_({.has_two_tiles = false, .seed = setup.seed ^ stream_id("ripple gusts")}),
        gust_places_(gusts_.places(water.rest_x_m, water.rest_z_m)),
        noise_(water.rest_x_m.size(), 0.0F),
        share_(water.rest_x_m.size(), 0.0F),
        skeleton_(std::move(water)),
        pose_(rest_pose(skeleton_)) {
    const SurfaceSkeleton& surface = *std::get_if<SurfaceSkeleton>(&skeleton_);
    if (setup.gusts) {
      outside_.emplace(setup.gusts, surface.rest_x_m, surface.rest_z_m, setup.row, kFinestCell_m, surface.columns);
    }

    // On deep water a wave's speed is sqrt(g length / 2 pi).
    const double length_m = values.number("wave_length");
    wave_speed_m_s_ = {std::sqrt(kGravity_m_s2 * length_m / (2.0 * std::numbers::pi)),
                       std::sqrt(kGravity_m_s2 * kShorter * length_m / (2.0 * std::numbers::pi))};
  }

  SimdRow row_;
  double height_m_;
  double half_speed_m_s_;
  double gustiness_;
  std::array<double, 2> wave_speed_m_s_{};

  SceneWind wind_;
  CriticallyDamped amplitude_m_;
  LayeredNoise waves_;
  CarriedNoise gusts_;               ///< of its own
  std::optional<WindGrid> outside_;  ///< and those of the wind outside, where there are any
  CarriedPlaces gust_places_;
  std::vector<float> noise_, share_;  ///< a point each
  Skeleton skeleton_;
  Pose pose_;
};

}  // namespace

extern const SceneDescription kRippleScene;
const SceneDescription kRippleScene = {.name = "ripple",
                                       .summary = "water under the wind: waves rise, and gusts roughen it as they pass",
                                       .parameters = kRippleParameters,
                                       .make = [](const ParameterValues& values, const SceneSetup& setup) {
                                         return std::unique_ptr<Scene>(std::make_unique<Ripple>(values, setup));
                                       }};

}  // namespace yuragi
