#include "engine/scenes/flame_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/philox.hpp"
#include "engine/math/portable.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/noise/torus.hpp"
#include "engine/noise/unit_reading.hpp"
#include "engine/operators/lean.hpp"
#include "engine/scenes/carried_noise.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kFlameGravity_m_s2 = 9.81;
constexpr double kBurnt_kg_m2_s = 0.02;
constexpr double kAir_kg_m3 = 1.2;

/// The height at which the wind is known, and the roughness of open land.
constexpr double kWindHeight_m = 10.0;
constexpr double kRoughness_m = 0.03;
constexpr double kMinWindHeight_m = 0.1;

constexpr double kSway_hz = 1.0;
constexpr double kSwayDamping = 0.7;

/// How soon the axis bends over the foot.
constexpr double kBendsOver = 25.0;

/// A smaller lean is set to 0: it moves nothing, and would become a denormal number.
constexpr double kUpright = 1e-12;

/// Its own sway has waves of 0.4 to 1.6 s, on a tile that is crossed in this time.
constexpr std::size_t kWobbleSamples = 128;
constexpr double kWobblePeriod_s = 12.8;
constexpr double kWobbleFrom = 8.0;  ///< waves a tile
constexpr double kWobbleTo = 32.0;
constexpr noise::TorusPhase kSouthOfEast{0x5a000000U, 0x93000000U};  ///< of the second component

noise::Tile2 wobble_tile(std::uint64_t seed) {
  noise::Tile2 tile = noise::make_noise_2d({.size = kWobbleSamples,
                                            .beta = 1.0,
                                            .seed = seed ^ math::stream_id("flame wobble"),
                                            .from_cycles = kWobbleFrom,
                                            .to_cycles = kWobbleTo})
                          .value();
  noise::scale_to_unit_reading(tile);
  return tile;
}

double largest_of(const noise::Tile2& tile) {
  float largest = 0.0F;
  for (const float value : tile.values) largest = std::max(largest, std::abs(value));
  return static_cast<double>(largest);
}

/// x^-0.21, as x^-(27/128): the measured exponent is less certain than the difference.
double power_of_length(double x) noexcept {
  const double eighth = std::sqrt(std::sqrt(std::sqrt(x)));
  const double sixteenth = std::sqrt(eighth);
  const double of_64 = std::sqrt(std::sqrt(sixteenth));
  return 1.0 / (eighth * sixteenth * of_64 * std::sqrt(of_64));
}

}  // namespace

FlameInWind FlameInWind::at(double relative_wind) noexcept {
  const double cosine = 1.0 / std::sqrt(std::sqrt(1.0 + relative_wind * relative_wind));
  return {.lean = std::sqrt((1.0 - cosine) / (1.0 + cosine)), .part = power_of_length(std::max(relative_wind, 1.0))};
}

void FlameAxis::Oscillator::step(const operators::OscillatorStep& step, double target) noexcept {
  const double distance = value - target;
  value = target + step.q_from_e * distance + step.q_from_v * rate;
  rate = step.v_from_e * distance + step.v_from_v * rate;
  if (target == 0.0 && std::abs(value) < kUpright && std::abs(rate) < kUpright) *this = {};
}

FlameAxis::FlameAxis(const FlameAxisSpec& spec)
    : spec_(spec),
      wobble_(wobble_tile(spec.seed)),
      wobble_steepest_per_s_(steepest_slope(wobble_, kWobblePeriod_s)),
      wobble_largest_(largest_of(wobble_)),
      history_(kChannels, spec.height_m / spec.rise_m_s) {
  // Rounded to floats, so that the last bit of a library's logarithm changes nothing.
  const double felt_m = std::max(spec.felt_at_m, kMinWindHeight_m);
  const double felt = std::log(felt_m / kRoughness_m) / std::log(kWindHeight_m / kRoughness_m);
  const double own_m_s = math::cube_root(kFlameGravity_m_s2 * kBurnt_kg_m2_s * spec.foot_m / kAir_kg_m3);
  relative_wind_s_m_ = static_cast<double>(static_cast<float>(felt / own_m_s));
  strongest_ = FlameInWind::at(relative_wind_s_m_ * spec.strongest_m_s);
  for (std::size_t row = 0; row < spec.rows; ++row) {
    const double v = static_cast<double>(row) / static_cast<double>(spec.rows - 1);
    turned_.push_back(static_cast<float>(1.0 - std::exp(-kBendsOver * v)));
  }
}

void FlameAxis::step(double east_m_s, double south_m_s, double dt_s) noexcept {
  const double speed_m_s = std::sqrt(east_m_s * east_m_s + south_m_s * south_m_s);
  const FlameInWind wanted = FlameInWind::at(relative_wind_s_m_ * speed_m_s);
  const double per_wind_s_m = speed_m_s > 0.0 ? wanted.lean / speed_m_s : 0.0;
  const operators::OscillatorStep step = operators::OscillatorStep::exact(kSway_hz, kSwayDamping, dt_s);
  lean_east_.step(step, per_wind_s_m * east_m_s);
  lean_south_.step(step, per_wind_s_m * south_m_s);
  missing_.step(step, 1.0 - wanted.part);

  wobbled_.add(dt_s, kWobblePeriod_s);
  const auto wobble = static_cast<float>(spec_.wobble);
  std::array<float, kChannels> now{};
  now[kLeanEast] = static_cast<float>(lean_east_.value);
  now[kLeanSouth] = static_cast<float>(lean_south_.value);
  now[kMissing] = static_cast<float>(missing_.value);
  now[kWobbleEast] = wobble * noise::read_noise(wobble_, wobbled_.phase());
  now[kWobbleSouth] = wobble * noise::read_noise(wobble_, wobbled_.phase() - kSouthOfEast);
  history_.push(now, dt_s);
}

void FlameAxis::write(const Rows& rows) const noexcept {
  const double delay_s = spec_.height_m / static_cast<double>(spec_.rows - 1) / spec_.rise_m_s;
  const auto link_m = static_cast<float>(spec_.height_m / static_cast<double>(spec_.rows - 1));
  float at_east_m = 0.0F;
  float at_south_m = 0.0F;
  float at_drop_m = 0.0F;
  for (std::size_t row = 0; row < spec_.rows; ++row) {
    float lean_east = 0.0F;
    float lean_south = 0.0F;
    if (row > 0) {
      const operators::PropagationHistory::Between then = history_.at(delay_s * static_cast<double>(row));
      const auto was = [&then](std::size_t channel) {
        return then.newer[channel] + then.fraction * (then.older[channel] - then.newer[channel]);
      };
      const float long_m = link_m * (1.0F - was(kMissing));
      lean_east = turned_[row] * (was(kLeanEast) + was(kWobbleEast));
      lean_south = turned_[row] * (was(kLeanSouth) + was(kWobbleSouth));
      const operators::LinkEnd<float> end = operators::link_end(lean_east, lean_south, 2.0F * long_m);
      at_east_m += end.east;
      at_south_m += end.south;
      at_drop_m += link_m - (end.down - long_m);  // it goes up by the amount that a hanging one would go down
    }
    rows.east_m[row] = at_east_m;
    rows.south_m[row] = at_south_m;
    rows.drop_m[row] = at_drop_m;
    rows.slope_east[row] = lean_east;
    rows.slope_south[row] = lean_south;
  }
}

/// In a tick the lean, which follows a target within the strongest wind's, moves by that times the oscillator's largest
/// rate, and the wobble by its steepest slope in each of two components. Values read from the history change no faster
/// than those written.
double FlameAxis::largest_slope_step(double dt_s) const noexcept {
  const double rate = std::min(operators::OscillatorStep::largest_rate_per_s(kSway_hz, kSwayDamping) * dt_s,
                               2.0 * operators::OscillatorStep::largest_gain(kSwayDamping));
  const double wobble = std::min(wobble_steepest_per_s_ * dt_s, 2.0 * wobble_largest_);
  return strongest_.lean * rate + std::sqrt(2.0) * spec_.wobble * wobble;
}

double FlameAxis::largest_slope() const noexcept {
  return strongest_.lean * operators::OscillatorStep::largest_gain(kSwayDamping) +
         std::sqrt(2.0) * spec_.wobble * wobble_largest_;
}

/// A row stands on the sum of its links, whose lengths add up to less than height (1 + overshoot). A link of length l
/// that leans by d more and grows by g moves by at most l 2 d + g (lean.hpp). The length follows in the same way as the
/// lean.
double FlameAxis::largest_step_m(double dt_s) const noexcept {
  const double gain = operators::OscillatorStep::largest_gain(kSwayDamping);
  const double rate =
      std::min(operators::OscillatorStep::largest_rate_per_s(kSway_hz, kSwayDamping) * dt_s, 2.0 * gain);
  const double missing = 1.0 - strongest_.part;
  return spec_.height_m * (2.0 * (1.0 + (gain - 1.0) * missing) * largest_slope_step(dt_s) + missing * rate);
}

}  // namespace yuragi::scenes
