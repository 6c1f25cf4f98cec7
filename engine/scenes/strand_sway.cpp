#include "engine/scenes/strand_sway.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/operators/bending_job.hpp"
#include "engine/pose/pose_arrays.hpp"

namespace yuragi {
namespace {

constexpr std::array<std::string_view, 2> kBetaMeanings = {"transect", "radial"};

double largest_of(std::span<const float> values) {
  return values.empty() ? 0.0 : static_cast<double>(*std::max_element(values.begin(), values.end()));
}

}  // namespace

StrandSway::StrandSway(StrandSkeleton strands, std::span<const float> place_x_m, std::span<const float> place_z_m,
                       std::vector<float> flexibility, const StrandSwaySpec& spec, SimdRow row)
    : row_(row),
      spec_(spec),
      noise_(spec.noise),
      along_(make_noise_2d({.size = spec.noise.samples,
                            .beta = spec.noise.beta,
                            .meaning = spec.noise.meaning,
                            .seed = spec.noise.seed ^ stream_id("along the wind")})
                 .value()),
      places_(noise_.places(place_x_m, place_z_m)),
      flexibility_(std::move(flexibility)),
      strength_(flexibility_.size(), 0.0F),
      oscillators_(flexibility_.size()),
      largest_flexibility_(largest_of(flexibility_)),
      lever_m_(largest_of(strands.link_length_m) * (static_cast<double>(strands.links_per_strand) + 1.0) / 2.0),
      skeleton_(std::move(strands)),
      pose_(rest_pose(skeleton_)) {
  steepest_along_per_m_ = steepest_slope(along_, spec_.noise.period_m);
  largest_along_ = largest_of(along_.values);
}

void StrandSway::shift(WindVector wind, double dt_s) noexcept {
  // The wind on the ground goes with the wind, and with the way that it has come its strength along it.
  wind_.step(wind, dt_s);
  noise_.shift(spec_.carry * wind_.east_m_s(), spec_.carry * wind_.south_m_s(), dt_s);
  way_.add(spec_.carry * wind_.speed_m_s() * dt_s, spec_.noise.period_m);
}

template <class Value>
std::span<Value> StrandSway::of_part(Part part, std::span<Value> values) const noexcept {
  const std::size_t blocks = values.size() / kStrandsPerBlock;
  const std::size_t begin = part.begin(blocks) * kStrandsPerBlock;
  return values.subspan(begin, part.end(blocks) * kStrandsPerBlock - begin);
}

void StrandSway::sample_part(Part part) noexcept {
  // How strong the wind is at each strand, as a factor.
  const std::span<float> strength = of_part(part, std::span(strength_));
  const auto first = static_cast<std::size_t>(strength.data() - strength_.data());
  noise_.sample(places_, row_, strength, static_cast<float>(spec_.turbulence), 1.0F, 0.0F,
                std::numeric_limits<float>::infinity(), first);
}

void StrandSway::project_part(Part part, double dt_s) noexcept {
  StrandPose& pose = *std::get_if<StrandPose>(&pose_);
  const std::span<float> bend_east_rad = of_part(part, std::span(pose.bend_east_rad));
  const std::span<float> bend_south_rad = of_part(part, std::span(pose.bend_south_rad));

  // Wind-speed times theta bends the strand toward where the wind blows.
  const double along = static_cast<double>(read_noise(along_, way_.phase()));
  const double wind_speed = std::max(1.0 + spec_.gust_strength * along, 0.0);
  BendingJob{.wind_east_m_s = wind_speed * wind_.east_m_s(),
             .wind_south_m_s = wind_speed * wind_.south_m_s(),
             .strength = of_part(part, std::span<const float>(strength_)),
             .flexibility = of_part(part, std::span<const float>(flexibility_)),
             .half_bend_speed_m_s = spec_.half_bend_speed_m_s,
             .max_bend_rad = spec_.max_bend_rad,
             .row = row_,
             .bend_east_rad = bend_east_rad,
             .bend_south_rad = bend_south_rad}
      .run();

  // And the strand, a damped oscillator, follows, overshoots, and sways on.
  OscillatorJob{.step = OscillatorStep::exact(spec_.natural_hz, spec_.damping_ratio, dt_s),
                .blend = spec_.hybrid,
                .row = row_,
                .oscillators = &oscillators_,
                .first = static_cast<std::size_t>(bend_east_rad.data() - pose.bend_east_rad.data()),
                .east = bend_east_rad,
                .south = bend_south_rad}
      .run();
}

double StrandSway::largest_joint_step_m(double dt_s) const noexcept {
  const double steepest = 3.0 * std::numbers::sqrt3 / 8.0;
  const double largest_strength = 1.0 + spec_.turbulence * std::max(noise_.highest(), 0.0);
  const double largest_gust = 1.0 + spec_.gust_strength * largest_along_;
  const double carried_m_s = spec_.carry * kStrongestSceneWind_m_s;
  const double carried_step_m_s = spec_.carry * SceneWind::largest_step_m_s(dt_s);

  // The largest change in a tick of s = wind * gust * strength * flexibility / half-bend speed.
  const double per_m_s = largest_flexibility_ / spec_.half_bend_speed_m_s;
  const double from_wind = SceneWind::largest_step_m_s(dt_s) * largest_gust * largest_strength;
  const double from_strength = kStrongestSceneWind_m_s * largest_gust * spec_.turbulence *
                               noise_.largest_change(carried_m_s, carried_step_m_s, dt_s);
  const double from_gust =
      kStrongestSceneWind_m_s * largest_strength * spec_.gust_strength * steepest_along_per_m_ * carried_m_s * dt_s;
  const double s = per_m_s * (from_wind + from_strength + from_gust);

  const double bend_rad = std::min(spec_.max_bend_rad * steepest * s, 2.0 * spec_.max_bend_rad);
  const double swaying_rad =
      std::min(OscillatorStep::largest_gain(spec_.damping_ratio) * bend_rad,
               OscillatorStep::largest_rate_per_s(spec_.natural_hz, spec_.damping_ratio) * dt_s * spec_.max_bend_rad);
  return lever_m_ * ((1.0 - spec_.hybrid) * bend_rad + spec_.hybrid * swaying_rad);
}

std::vector<Parameter> strand_sway_parameters(const StrandSwaySpec& defaults) {
  using namespace std::string_literals;
  return {
      {"max_bend", "deg", defaults.max_bend_rad / kRadPerDeg, 0, 170, "how far the strongest wind bends a tip"},
      {"half_bend_speed", "m/s", defaults.half_bend_speed_m_s, 0.1, 60, "the wind that bends a tip half as far"},
      {"turbulence", "", defaults.turbulence, 0, 2,
       "how much the wind differs from place to place: its standard deviation, as a part of it"},
      {"gust_strength", "", defaults.gust_strength, 0, 2,
       "how much it swells and dies away along its path, in the same measure"},
      {"hybrid", "", defaults.hybrid, 0, 1,
       "0: bends follow the noise alone; 1: each strand is a damped oscillator that overshoots and sways on"},
      {"natural_frequency", "Hz", defaults.natural_hz, 0.1, 20, "how fast a strand sways by itself"},
      {"damping", "", defaults.damping_ratio, 0.02, 0.95, "how soon that dies away: the damping ratio"},
      {"carry", "", defaults.carry, 0, 1, "the noise travels with this part of the wind's speed"},
      {"tile_period", "m", defaults.noise.period_m, 0.5, 4096,
       "after how many metres the wind on the ground repeats; 512 samples"},
      {"tiles", "", std::int64_t{defaults.noise.has_two_tiles ? 2 : 1}, 1, 2,
       "2: a second tile is added, so that no repeat is seen; 1: the paper's letter"},
      {"beta", "", defaults.noise.beta, 0, 4, "exponent of the wind's spectrum, 1/f^beta; 5/3 is Simiu's wind"},
      {"beta_meaning",
       "",
       std::string(name_of(defaults.noise.meaning)),
       {},
       {},
       "transect: of a line through the field, true to the wind; radial: of each mode, the paper's letter",
       kBetaMeanings},
  };
}

StrandSwaySpec strand_sway_spec(const ParameterValues& values, std::uint64_t seed) {
  const bool is_radial = values.text("beta_meaning") == "radial";
  return {.max_bend_rad = values.number("max_bend") * kRadPerDeg,
          .half_bend_speed_m_s = values.number("half_bend_speed"),
          .turbulence = values.number("turbulence"),
          .gust_strength = values.number("gust_strength"),
          .hybrid = values.number("hybrid"),
          .natural_hz = values.number("natural_frequency"),
          .damping_ratio = values.number("damping"),
          .carry = values.number("carry"),
          .noise = {.period_m = values.number("tile_period"),
                    .beta = values.number("beta"),
                    .meaning = is_radial ? BetaMeaning::kRadial : BetaMeaning::kTransect,
                    .has_two_tiles = values.integer("tiles") == 2,
                    .seed = seed}};
}

}  // namespace yuragi
