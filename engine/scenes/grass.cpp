#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/noise/torus.hpp"
#include "engine/operators/bending_job.hpp"
#include "engine/operators/sample_job.hpp"
#include "engine/operators/shift_job.hpp"
#include "engine/scenes/meadow.hpp"
#include "engine/scenes/scene.hpp"

// Grass in the wind, after N. Chiba, "Development of core technology for a noise-based real-time animation engine for
// fluctuation phenomena" (Iwate University), section 3.1 and figure 7:
//
//   shift    the wind carries a 2-D noise of beta 5/3, "the wind on the ground", over the meadow   ShiftJob
//   sample   each blade reads it where it stands, scaled to a strength of the wind                 SampleJob
//   project  a 1-D noise gives Wind-speed, the strength along the wind; both together bend         BendingJob
//            the links of the blade

namespace yuragi {
namespace {

/// 256 m in 512 samples are cells of 0.5 m: what is read stays below half the tick rate up to 30 m/s at 60 Hz
/// (|k| U < pi rate), so that in a storm no blade jitters from tick to tick. And the meadow is small against 256 m: the
/// tile's period does not show (method, decision 7).
constexpr std::size_t kTileSamples = 512;

/// The period of the 1-D noise over that of the tile: the golden ratio, so that the two never come round together.
constexpr double kStrengthPeriodRatio = std::numbers::phi;

constexpr std::array<std::string_view, 2> kMeanings = {"transect", "radial"};

using namespace std::string_literals;

const std::array kGrassParameters = {
    Parameter{"blades_across", "", std::int64_t{100}, 1, 2000, "blades from west to east"},
    Parameter{"blades_deep", "", std::int64_t{100}, 1, 2000, "blades from north to south"},
    Parameter{"links", "", std::int64_t{10}, 1, 64, "links of a blade"},
    Parameter{"width", "m", 7.0, 0.1, 200, "the meadow from west to east"},
    Parameter{"depth", "m", 7.0, 0.1, 200, "the meadow from north to south"},
    Parameter{"blade_length", "m", 0.7, 0.05, 3, "length of a blade, on average"},
    Parameter{"blade_length_variation", "", 0.25, 0, 0.5, "standard deviation of the length, as a part of it"},
    Parameter{"tilt", "deg", 8.0, 0, 60, "how far a blade's foot leans in calm air, on average"},
    Parameter{"curl", "deg", 35.0, 0, 180, "how far a blade droops from foot to tip in calm air, on average"},
    Parameter{"heading", "deg", 0.0, 0, 360, "where blades droop to on average, clockwise from north"},
    Parameter{"heading_spread", "deg", 150.0, 0, 180, "standard deviation of where they droop to"},
    Parameter{"max_bend", "deg", 80.0, 0, 170, "how far the strongest wind bends a tip"},
    Parameter{"half_bend_speed", "m/s", 7.0, 0.1, 60, "the wind that bends a tip half as far"},
    Parameter{"turbulence", "", 0.4, 0, 2,
              "how much the wind differs from place to place: its standard deviation, as a part of it"},
    Parameter{"gust_strength", "", 0.2, 0, 2, "how much it swells and dies away along its path, in the same measure"},
    Parameter{"tile_period", "m", 256.0, 16, 4096, "after how many metres the wind on the ground repeats; 512 samples"},
    Parameter{"beta", "", 5.0 / 3.0, 0, 4, "exponent of the wind's spectrum, 1/f^beta; 5/3 is Simiu's wind"},
    Parameter{"beta_meaning",
              "",
              "transect"s,
              {},
              {},
              "transect: of a line through the field, true to the wind; radial: of each mode, the paper's letter",
              kMeanings},
};

std::size_t size_in(const ParameterValues& values, std::string_view name) {
  return static_cast<std::size_t>(values.integer(name));
}

MeadowSpec meadow_spec(const ParameterValues& values, std::uint64_t seed) {
  return {.blades_across = size_in(values, "blades_across"),
          .blades_deep = size_in(values, "blades_deep"),
          .links = size_in(values, "links"),
          .width_m = values.number("width"),
          .depth_m = values.number("depth"),
          .length_m = values.number("blade_length"),
          .length_variation = values.number("blade_length_variation"),
          .tilt_deg = values.number("tilt"),
          .curl_deg = values.number("curl"),
          .heading_deg = values.number("heading"),
          .heading_spread_deg = values.number("heading_spread"),
          .seed = seed};
}

NoiseSpec wind_noise(const ParameterValues& values, std::uint64_t seed) {
  const bool radial = values.text("beta_meaning") == "radial";
  return {.size = kTileSamples,
          .beta = values.number("beta"),
          .meaning = radial ? BetaMeaning::kRadial : BetaMeaning::kTransect,
          .seed = seed};
}

std::vector<std::uint32_t> phases_of(const std::vector<float>& positions_m, double period_m) {
  std::vector<std::uint32_t> phases;
  phases.reserve(positions_m.size());
  for (const float position_m : positions_m) {
    phases.push_back(torus_phase(static_cast<double>(position_m), period_m));
  }
  return phases;
}

class Grass final : public Scene {
 public:
  Grass(const ParameterValues& values, const SceneSetup& setup)
      : Grass(make_meadow(meadow_spec(values, setup.seed)), values, setup) {}

  const Skeleton& skeleton() const noexcept override { return skeleton_; }
  const Pose& pose() const noexcept override { return pose_; }
  double largest_joint_step_m(double /*dt_s*/) const noexcept override { return 10.0; }

  void tick(WindVector wind, double dt_s) noexcept override {
    const double east_m_s = wind.u_m_s;
    const double south_m_s = -wind.v_m_s;

    // Shift: the wind on the ground goes with the wind, and with the way that it has come its strength along it.
    ShiftJob{
        .wind_east_m_s = east_m_s, .wind_south_m_s = south_m_s, .dt_s = dt_s, .period_m = period_m_, .offset = &offset_}
        .run();
    way_.add(std::sqrt(east_m_s * east_m_s + south_m_s * south_m_s) * dt_s, period_m_ * kStrengthPeriodRatio);

    // Sample: how strong the wind is at each blade, as a factor.
    SampleJob{.tile = &tile_,
              .place_x = place_x_,
              .place_z = place_z_,
              .offset = offset_.phase(),
              .scale = turbulence_,
              .bias = 1.0F,
              .low = 0.0F,
              .row = row_,
              .out = strength_}
        .run();

    // Project: Wind-speed times theta bends the blade toward where the wind blows.
    const double along = 1.0 + gust_strength_ * static_cast<double>(read_noise(along_, 0U - way_.phase()));
    const double wind_speed = std::max(along, 0.0);
    auto& strands = *std::get_if<StrandPose>(&pose_);
    BendingJob{.wind_east_m_s = wind_speed * east_m_s,
               .wind_south_m_s = wind_speed * south_m_s,
               .strength = strength_,
               .flexibility = flexibility_,
               .half_bend_speed_m_s = half_bend_speed_m_s_,
               .max_bend_rad = max_bend_rad_,
               .row = row_,
               .bend_east_rad = strands.bend_east_rad,
               .bend_south_rad = strands.bend_south_rad}
        .run();
  }

 private:
  Grass(Meadow meadow, const ParameterValues& values, const SceneSetup& setup)
      : row_(setup.row),
        period_m_(values.number("tile_period")),
        turbulence_(static_cast<float>(values.number("turbulence"))),
        gust_strength_(values.number("gust_strength")),
        half_bend_speed_m_s_(values.number("half_bend_speed")),
        max_bend_rad_(values.number("max_bend") * kRadPerDeg),
        tile_(make_noise_2d(wind_noise(values, setup.seed ^ stream_id("grass wind on the ground"))).value()),
        along_(make_noise_1d(wind_noise(values, setup.seed ^ stream_id("grass wind-speed"))).value()),
        place_x_(phases_of(meadow.skeleton.root_x_m, period_m_)),
        place_z_(phases_of(meadow.skeleton.root_z_m, period_m_)),
        flexibility_(std::move(meadow.flexibility)),
        strength_(flexibility_.size(), 0.0F),
        pose_(StrandPose{std::vector<float>(flexibility_.size(), 0.0F), std::vector<float>(flexibility_.size(), 0.0F)}),
        skeleton_(std::move(meadow.skeleton)) {}

  SimdRow row_;
  double period_m_;
  float turbulence_;
  double gust_strength_;
  double half_bend_speed_m_s_;
  double max_bend_rad_;

  NoiseTile2 tile_;   ///< the wind on the ground
  NoiseTile1 along_;  ///< Wind-speed: the strength along the wind's way
  TorusOffset offset_;
  TorusTravel way_;

  std::vector<std::uint32_t> place_x_, place_z_;  ///< of each blade, on the tile
  std::vector<float> flexibility_;
  std::vector<float> strength_;
  Pose pose_;
  Skeleton skeleton_;
};

}  // namespace

extern const SceneDescription kGrassScene;
const SceneDescription kGrassScene = {.name = "grass",
                                      .summary = "a meadow in the wind: blades bend as gusts pass over them",
                                      .parameters = kGrassParameters,
                                      .make = [](const ParameterValues& values, const SceneSetup& setup) {
                                        return std::unique_ptr<Scene>(std::make_unique<Grass>(values, setup));
                                      }};

}  // namespace yuragi
