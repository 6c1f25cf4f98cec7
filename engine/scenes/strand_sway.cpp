#include "engine/scenes/strand_sway.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/operators/bend_share.hpp"
#include "engine/operators/bending_job.hpp"
#include "engine/operators/local_bending_job.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/canopy_carry.hpp"
#include "engine/scenes/strand_part.hpp"

namespace yuragi::scenes {
namespace {

/// Maximum difference of the strands' natural rates.
constexpr double kPaceSpread = 0.15;

constexpr std::array<std::string_view, 2> kGusts = {"outside", "own"};
/// How many standard deviations the canopy's waves reach.
constexpr double kMaxCanopyWave = 2.2;

/// Shorter strands are faster: each strand's rate relative to that of one of mean length.
std::vector<float> natural_rates_hz(const pose::StrandSkeleton& strands, double mean_hz) {
  const auto all = std::span(strands.link_length_m).first(strands.strand_count);
  const double mean_m =
      std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(std::max<std::size_t>(all.size(), 1));
  std::vector<float> rates_hz(strands.padded_count(), static_cast<float>(mean_hz));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double faster = std::clamp(mean_m / static_cast<double>(all[i]), 1.0 - kPaceSpread, 1.0 + kPaceSpread);
    rates_hz[i] = static_cast<float>(mean_hz * faster);
  }
  return rates_hz;
}

double largest_of(std::span<const float> values) {
  return values.empty() ? 0.0 : static_cast<double>(*std::max_element(values.begin(), values.end()));
}

}  // namespace

StrandSway::OwnGusts::OwnGusts(const StrandSwaySpec& spec, std::span<const float> place_x_m,
                               std::span<const float> place_z_m)
    : noise(spec.noise),
      places(noise.places(place_x_m, place_z_m)),
      along(noise::make_noise_2d({.size = spec.noise.samples,
                                  .beta = spec.noise.beta,
                                  .meaning = spec.noise.meaning,
                                  .seed = spec.noise.seed ^ math::stream_id("along the wind")})
                .value()),
      largest_along(largest_of(along.values)),
      steepest_along_per_m(steepest_slope(along, spec.noise.period_m)),
      strength(place_x_m.size(), 0.0F) {}

StrandSway::OutsideGusts::OutsideGusts(const pose::StrandSkeleton& strands, const StrandSwaySpec& spec,
                                       const Setup& setup)
    : grid(setup.gusts, strands.root_x_m, strands.root_z_m, setup.row, spec.finest_wind_cell_m, strands.columns),
      east_m_s(strands.padded_count(), 0.0F),
      south_m_s(strands.padded_count(), 0.0F),
      canopy(CarriedNoise::band(spec.shortest_canopy_wave_m, 2.0 * spec.shortest_canopy_wave_m,
                                setup.seed ^ math::stream_id("canopy waves"), false)),
      places(canopy.places(strands.root_x_m, strands.root_z_m)),
      strength(strands.padded_count(), 1.0F) {}

StrandSway::StrandSway(pose::StrandSkeleton strands, std::span<const float> place_x_m, std::span<const float> place_z_m,
                       std::vector<float> flexibility, const StrandSwaySpec& spec, const Setup& setup)
    : row_(setup.row),
      spec_(spec),
      wind_(setup.placement, setup.gusts),
      flexibility_(std::move(flexibility)),
      oscillators_(flexibility_.size()),
      natural_hz_(natural_rates_hz(strands, spec.natural_hz)),
      steps_(flexibility_.size()),
      largest_flexibility_(largest_of(flexibility_)),
      lever_m_(largest_of(strands.link_length_m) * (static_cast<double>(strands.links_per_strand) + 1.0) / 2.0),
      canopy_carry_(canopy_carry(spec.plant_height_m)),
      skeleton_(std::move(strands)),
      pose_(pose::rest_pose(skeleton_)) {
  if (setup.gusts) spec_.gust_strength = 0.0;
  if (setup.gusts && !spec.has_own_gusts) {
    outside_.emplace(*std::get_if<pose::StrandSkeleton>(&skeleton_), spec, setup);
  } else {
    own_.emplace(spec, place_x_m, place_z_m);
  }
}

void StrandSway::shift(const wind::ground::Wind& wind, double dt_s) noexcept {
  steps_.set_pace(natural_hz_, spec_.damping_ratio, dt_s);
  wind_.step(wind, dt_s);
  if (outside_) {
    outside_->grid.step(wind, dt_s);
    outside_->canopy.shift(canopy_carry_ * wind_.east_m_s(), canopy_carry_ * wind_.south_m_s(), dt_s);
    return;
  }
  // The wind on the ground moves with the wind, and its strength along the wind with the path.
  own_->noise.shift(spec_.carry * wind_.east_m_s(), spec_.carry * wind_.south_m_s(), dt_s);
  own_->way.add(spec_.carry * wind_.speed_m_s() * dt_s, spec_.noise.period_m);
}

void StrandSway::sample_part(Part part) noexcept {
  if (outside_) {
    // The wind at each strand, and by how much the canopy's waves vary it.
    const std::span<float> east_m_s = strands_of(part, std::span(outside_->east_m_s));
    const auto first = static_cast<std::size_t>(east_m_s.data() - outside_->east_m_s.data());
    outside_->grid.sample(first, east_m_s, strands_of(part, std::span(outside_->south_m_s)));
    if (spec_.canopy_waves > 0.0) {
      const auto largest = static_cast<float>(spec_.canopy_waves * kMaxCanopyWave);
      outside_->canopy.sample(outside_->places, row_, strands_of(part, std::span(outside_->strength)),
                              static_cast<float>(spec_.canopy_waves), 1.0F, 1.0F - largest, 1.0F + largest, first);
    }
    return;
  }
  // The strength of the wind at each strand, as a factor.
  const std::span<float> strength = strands_of(part, std::span(own_->strength));
  const auto first = static_cast<std::size_t>(strength.data() - own_->strength.data());
  own_->noise.sample(own_->places, row_, strength, static_cast<float>(spec_.turbulence), 1.0F, 0.0F,
                     std::numeric_limits<float>::infinity(), first);
}

void StrandSway::project_part(Part part, double) noexcept {
  pose::StrandPose& pose = *std::get_if<pose::StrandPose>(&pose_);
  const std::span<const float> flexibility = strands_of(part, std::span<const float>(flexibility_));
  const std::span<float> bend_east_rad = strands_of(part, std::span(pose.bend_east_rad));
  const std::span<float> bend_south_rad = strands_of(part, std::span(pose.bend_south_rad));

  // The wind bends the strand downwind.
  if (outside_) {
    operators::LocalBendingJob{.wind_east_m_s = strands_of(part, std::span<const float>(outside_->east_m_s)),
                               .wind_south_m_s = strands_of(part, std::span<const float>(outside_->south_m_s)),
                               .strength = strands_of(part, std::span<const float>(outside_->strength)),
                               .flexibility = flexibility,
                               .half_bend_speed_m_s = spec_.half_bend_speed_m_s,
                               .max_bend_rad = spec_.max_bend_rad,
                               .row = row_,
                               .bend_east_rad = bend_east_rad,
                               .bend_south_rad = bend_south_rad}
        .run();
  } else {
    const double along = static_cast<double>(noise::read_noise(own_->along, own_->way.phase()));
    const double wind_speed = std::max(1.0 + spec_.gust_strength * along, 0.0);
    operators::BendingJob{.wind_east_m_s = wind_speed * wind_.east_m_s(),
                          .wind_south_m_s = wind_speed * wind_.south_m_s(),
                          .strength = strands_of(part, std::span<const float>(own_->strength)),
                          .flexibility = flexibility,
                          .half_bend_speed_m_s = spec_.half_bend_speed_m_s,
                          .max_bend_rad = spec_.max_bend_rad,
                          .row = row_,
                          .bend_east_rad = bend_east_rad,
                          .bend_south_rad = bend_south_rad}
        .run();
  }

  // And the strand, a damped oscillator, follows, overshoots, and sways on.
  operators::OscillatorJob{.steps = &steps_,
                           .blend = spec_.hybrid,
                           .row = row_,
                           .oscillators = &oscillators_,
                           .first = static_cast<std::size_t>(bend_east_rad.data() - pose.bend_east_rad.data()),
                           .east = bend_east_rad,
                           .south = bend_south_rad}
      .run();
}

/// The largest change in a tick of wind * gust * strength, m/s.
double StrandSway::largest_bend_input_step(double dt_s) const noexcept {
  const double wind_step_m_s = Wind::largest_step_m_s(dt_s);
  if (outside_) {
    const double largest_wave = spec_.canopy_waves * kMaxCanopyWave;
    const double wave_step =
        spec_.canopy_waves *
        outside_->canopy.largest_change(canopy_carry_ * kStrongestSceneWind_m_s, canopy_carry_ * wind_step_m_s, dt_s);
    return wind_step_m_s * (1.0 + largest_wave) + kStrongestSceneWind_m_s * std::min(wave_step, 2.0 * largest_wave);
  }
  const double largest_strength = 1.0 + spec_.turbulence * std::max(own_->noise.highest(), 0.0);
  const double largest_gust = 1.0 + spec_.gust_strength * own_->largest_along;
  const double carried_m_s = spec_.carry * kStrongestSceneWind_m_s;
  const double from_wind = wind_step_m_s * largest_gust * largest_strength;
  const double from_strength = kStrongestSceneWind_m_s * largest_gust * spec_.turbulence *
                               own_->noise.largest_change(carried_m_s, spec_.carry * wind_step_m_s, dt_s);
  const double from_gust = kStrongestSceneWind_m_s * largest_strength * spec_.gust_strength *
                           own_->steepest_along_per_m * carried_m_s * dt_s;
  return from_wind + from_strength + from_gust;
}

double StrandSway::largest_joint_step_m(double dt_s) const noexcept {
  const double s = largest_flexibility_ / spec_.half_bend_speed_m_s * largest_bend_input_step(dt_s);
  const double bend_rad = std::min(spec_.max_bend_rad * operators::kSteepestBendShare * s, 2.0 * spec_.max_bend_rad);
  const double swaying_rad = std::min(
      operators::OscillatorStep::largest_gain(spec_.damping_ratio) * bend_rad,
      operators::OscillatorStep::largest_rate_per_s((1.0 + kPaceSpread) * spec_.natural_hz, spec_.damping_ratio) *
          dt_s * spec_.max_bend_rad);
  return lever_m_ * ((1.0 - spec_.hybrid) * bend_rad + spec_.hybrid * swaying_rad);
}

Fields<StrandSwaySpec> strand_sway_fields(const StrandSwaySpec& defaults) {
  const auto of_noise = [](auto member) { return member_of(&StrandSwaySpec::noise, member); };
  const auto are_two = [](std::int64_t tiles) { return tiles == 2; };
  return {
      {{"max_bend", "deg", defaults.max_bend_rad / kRadPerDeg, 0, 170, "how far the strongest wind bends a tip"},
       &StrandSwaySpec::max_bend_rad,
       radians_of},
      {{"half_bend_speed", "m/s", defaults.half_bend_speed_m_s, 0.1, 60, "the wind that bends a tip half as far"},
       &StrandSwaySpec::half_bend_speed_m_s},
      {{"gusts",
        "",
        std::string(kGusts[defaults.has_own_gusts ? 1 : 0]),
        {},
        {},
        "outside: the gusts of the wind outside, which pass over all scenes; own: a noise of this scene",
        kGusts},
       &StrandSwaySpec::has_own_gusts,
       [](const std::string& word) { return word == kGusts[1]; }},
      {{"turbulence", "", defaults.turbulence, 0, 2,
        "own gusts: how much the wind differs from place to place: its standard deviation, as a part of it"},
       &StrandSwaySpec::turbulence},
      {{"gust_strength", "", defaults.gust_strength, 0, 2,
        "own gusts: how much the wind swells in time, in the same measure; a wind with gusts needs none"},
       &StrandSwaySpec::gust_strength},
      {{"canopy_waves", "", defaults.canopy_waves, 0, 0.4,
        "outside gusts: how much waves of the meadow itself, 2 to 4 m long, vary the wind: the bands that run over a "
        "meadow"},
       &StrandSwaySpec::canopy_waves},
      {{"hybrid", "", defaults.hybrid, 0, 1,
        "0: bends follow the noise alone; 1: each strand is a damped oscillator that overshoots and sways on"},
       &StrandSwaySpec::hybrid},
      {{"natural_frequency", "Hz", defaults.natural_hz, 0.1, 20,
        "frequency at which a strand of mean length sways by itself; shorter ones sway up to 15 % faster"},
       &StrandSwaySpec::natural_hz},
      {{"damping", "", defaults.damping_ratio, 0.02, 0.95, "how soon that sway ends: the damping ratio"},
       &StrandSwaySpec::damping_ratio},
      {{"carry", "", defaults.carry, 0, 1, "the noise travels with this part of the wind's speed"},
       &StrandSwaySpec::carry},
      {{"tile_period", "m", defaults.noise.period_m, 0.5, 4096,
        "after how many metres the wind on the ground repeats; 512 samples"},
       of_noise(&CarriedNoiseSpec::period_m)},
      {{"tiles", "", std::int64_t{defaults.noise.has_two_tiles ? 2 : 1}, 1, 2,
        "2: a second tile is added, so that no repeat is seen; 1: the paper's letter"},
       of_noise(&CarriedNoiseSpec::has_two_tiles),
       are_two},
      {{"beta", "", defaults.noise.beta, noise::kMinTransectBeta2, 4,
        "exponent of the wind's spectrum, 1/f^beta; 5/3 is Simiu's wind"},
       of_noise(&CarriedNoiseSpec::beta)},
      {{"beta_meaning",
        "",
        std::string(noise::kBetaMeaningNames.at(static_cast<std::size_t>(defaults.noise.meaning))),
        {},
        {},
        "transect: of a line through the field, true to the wind; radial: of each mode, the paper's letter",
        noise::kBetaMeaningNames},
       of_noise(&CarriedNoiseSpec::meaning)},
  };
}

}  // namespace yuragi::scenes
