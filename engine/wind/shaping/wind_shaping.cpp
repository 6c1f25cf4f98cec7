#include "engine/wind/shaping/wind_shaping.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/math/portable.hpp"

namespace yuragi::wind::shaping {
namespace {

/// A critically damped step has covered 95 % after 4.75 time constants (engine/METHOD.md M18).
constexpr double kPhaseOfArrival = 4.75;
/// The time in which the floor's gain follows the mean.
constexpr double kFloorGainOver_s = 5.0;
/// A front is detected within this, so that the gain of a calm is not applied to a storm ...
constexpr double kQuickOver_s = 4.0;
/// ... and is distinguished from a gust by being this many times the slow mean.
constexpr double kFrontTimesMean = 2.0;
/// Longer than every transition: the first call starts at the targets.
constexpr double kForEver_s = 1e12;

constexpr double kRememberEvery_s = 1.0;
/// This much live wind (or this share of a short memory) is needed for the full weight of the site's percentiles.
constexpr double kKnownAfter_s = 6.0 * 3600.0;
constexpr double kKnownShare = 0.25;
constexpr double kMedian = 0.50;
constexpr double kStrong = 0.95;
/// Below the resolution of sensors in a calm.
constexpr double kMinMedian_m_s = 0.05;

/// Advances the filter, and ends exactly at the target.
void follow_to_the_end(math::CriticallyDamped& value, double target, double over_s, double dt_s) noexcept {
  constexpr double kArrived = 1e-6;
  value.step(target, kPhaseOfArrival / over_s, dt_s);
  if (std::abs(value.value - target) < kArrived && std::abs(value.rate_per_s) < kArrived) value = {target, 0.0};
}

/// The same angle within half a turn of 0.
double within_half_a_turn(double angle, double full_turn) noexcept {
  return std::remainder(angle, full_turn);
}

double part_of(const math::CriticallyDamped& value) noexcept {
  return std::clamp(value.value, 0.0, 1.0);
}

/// The breeze, or the wind by hand, has carried the tapes farther, too.
void carry_tapes(ground::WindStroke& stroke, Vector blown_m, double way_m) noexcept {
  stroke.way_m += way_m;
  stroke.carried_east_m += blown_m.u_m_s;
  stroke.carried_south_m -= blown_m.v_m_s;
  for (ground::WindPen& pen : stroke.pens) {
    for (ground::WindSample* sample : {&pen.now, &pen.written}) {
      sample->east_m -= blown_m.u_m_s;
      sample->south_m += blown_m.v_m_s;
    }
  }
}

/// Gusts become stronger by some that are not measured: the measured ones are then a smaller part of the power.
void know_less(ground::WindStroke& stroke, const turbulence::GustNoise::Moment& real,
               const turbulence::GustNoise::Moment& all) noexcept {
  const auto part = [](float of_m_s, float all_m_s) {
    return all_m_s > 0.0F ? of_m_s * of_m_s / (all_m_s * all_m_s) : 0.0F;
  };
  for (std::size_t i = 0; i < ground::kTileOctaveCount; ++i) {
    const std::size_t octave = turbulence::GustNoise::kFirstTileOctave + i;
    const float along = part(real.along_m_s[octave], all.along_m_s[octave]);
    const float across = part(real.across_m_s[octave], all.across_m_s[octave]);
    for (ground::WindPen& pen : stroke.pens) {
      for (ground::WindSample* sample : {&pen.now, &pen.written}) {
        sample->known_along[i] *= along;
        sample->known_across[i] *= across;
      }
    }
  }
}

}  // namespace

WindShaping::WindShaping(const WindShapingSettings& settings, std::shared_ptr<const turbulence::GustNoise> noise)
    : settings_(settings),
      now_(strengths_of(settings)),
      ceiling_(settings.ceiling),
      noise_(std::move(noise)),
      along_(turbulence::gust_variances(*noise_, settings.turbulence_intensity, settings.length_m)),
      across_(turbulence::gust_variances(*noise_, turbulence::kAcrossPerAlong * settings.turbulence_intensity,
                                         settings.length_m)),
      memory_(settings.site_memory_s) {}

WindShaping::Strengths WindShaping::strengths_of(const WindShapingSettings& settings) noexcept {
  return {.floor_m_s = settings.floor_m_s,
          .gusts = settings.gusts,
          .per_ceiling_from_s_m = 1.0 / settings.ceiling.from_m_s,
          .per_ceiling_most_s_m = 1.0 / settings.ceiling.most_m_s};
}

void WindShaping::change(const WindShapingSettings& settings) noexcept {
  const WindShapingSettings before = settings_;
  settings_ = settings;
  settings_.turbulence_intensity = before.turbulence_intensity;
  settings_.length_m = before.length_m;
  if (settings.site_memory_s != before.site_memory_s) memory_.change_memory(settings.site_memory_s);
  look_at_memory();
  from_ = now_;
  change_ = {};
}

/// Moves from the settings before a change to the new ones, and ends exactly at those.
/// The ceiling follows from the settings, and during a change from the strengths.
void WindShaping::list_state(StatePass& pass) {
  pass(from_, now_, change_, memory_, median_m_s_, strong_m_s_, mean_, quick_mean_, site_, floor_, breeze_, opening_,
       openness_, hand_, dark_, hand_m_s_, hand_from_deg_, hand_turn_rad_, speed_m_s_, ceiling_gain_, time_,
       has_begun_);
  for (double* total : {&live_s_, &unstored_s_, &known_s_, &blown_m_.u_m_s, &blown_m_.v_m_s, &blown_way_m_,
                        &hand_blown_m_.u_m_s, &hand_blown_m_.v_m_s, &hand_way_m_}) {
    pass.total(*total);
  }
}

void WindShaping::change_strengths(double dt_s) noexcept {
  if (change_.value == 1.0) return;
  follow_to_the_end(change_, 1.0, kChangeOver_s, dt_s);
  now_ = strengths_of(settings_);
  ceiling_ = settings_.ceiling;
  if (change_.value == 1.0) return;
  const double part = change_.value;
  const auto between = [part](double before, double after) { return before + part * (after - before); };
  now_ = {.floor_m_s = between(from_.floor_m_s, now_.floor_m_s),
          .gusts = between(from_.gusts, now_.gusts),
          .per_ceiling_from_s_m = between(from_.per_ceiling_from_s_m, now_.per_ceiling_from_s_m),
          .per_ceiling_most_s_m = between(from_.per_ceiling_most_s_m, now_.per_ceiling_most_s_m)};
  ceiling_ = {.from_m_s = 1.0 / now_.per_ceiling_from_s_m, .most_m_s = 1.0 / now_.per_ceiling_most_s_m};
}

void WindShaping::shape(ground::DrivingWind& wind, bool is_open, bool is_of_site, const ByHand& by_hand) noexcept {
  State& state = wind.state;
  const double dt_s = has_begun_ ? std::max(0.0, seconds(state.time - time_)) : 0.0;
  if (!has_begun_ || state.time > time_) time_ = state.time;

  // The slow part: means, the site's distribution, and the gains from both.
  const double speed_m_s = speed_of(state.wind);
  const double way_s = std::exchange(has_begun_, true) ? dt_s : kForEver_s;
  change_strengths(dt_s);
  mean_.step(speed_m_s, kPhaseOfArrival / settings_.over_s, way_s);
  quick_mean_.step(speed_m_s, kPhaseOfArrival / kQuickOver_s, way_s);
  live_s_ = is_of_site && state.live_weight > 0.5 ? live_s_ + dt_s : 0.0;
  // By then the mean has forgotten the previous wind.
  if (live_s_ > settings_.over_s) remember(mean_.value, dt_s);
  follow(state.live_weight, is_open, way_s);
  follow_hand(by_hand, dt_s, way_s);

  // Factors, the breeze, the hand, and last the ceiling.
  apply_gains(wind);
  add_breeze(wind, dt_s);
  apply_hand(wind, dt_s);
  hold_back(wind);
}

/// Site gain, floor and opening: on all wind over the ground at this moment. Also the factor on gusts.
void WindShaping::apply_gains(ground::DrivingWind& wind) const noexcept {
  const double gain = site_.value * floor_.value * opening_.value;
  wind.state.wind = gain * wind.state.wind;
  wind.ground = gain * wind.ground;
  if (now_.gusts == 1.0) return;
  wind.ground.gust_gain = now_.gusts;
  const Vector way = noise_->everywhere(wind.ground.gusts);
  wind.ground.everywhere = wind.ground.everywhere + (now_.gusts - 1.0) * way;
  for (float& deviation : wind.ground.gusts.along_m_s) deviation *= static_cast<float>(now_.gusts);
  for (float& deviation : wind.ground.gusts.across_m_s) deviation *= static_cast<float>(now_.gusts);
  wind.state.wind = wind_where_measured(wind.ground, wind.stroke, *noise_);
}

/// The ceiling: on the wind measured now, while it crosses the ground.
void WindShaping::hold_back(ground::DrivingWind& wind) noexcept {
  speed_m_s_ = speed_of(wind.state.wind);
  ceiling_gain_ = ceiling_.gain(speed_m_s_);
  wind.state.wind = ceiling_gain_ * wind.state.wind;
  if (wind.stroke.pen_count == 0) wind.ground = ceiling_gain_ * wind.ground;
  for (ground::WindPen& pen : wind.stroke.pens) pen.now.gain = pen.written.gain = ceiling_gain_;
}

bool WindShaping::restore(std::span<const double> times_s) noexcept {
  if (!memory_.restore(times_s)) return false;
  look_at_memory();
  return true;
}

/// Adds the speed to the site's memory, at most once a second.
void WindShaping::remember(double mean_m_s, double dt_s) noexcept {
  if (settings_.site.median_m_s <= 0.0) return;
  unstored_s_ += dt_s;
  if (unstored_s_ < kRememberEvery_s) return;
  memory_.add(std::max(mean_m_s, 0.0), std::exchange(unstored_s_, 0.0));
  look_at_memory();
}

void WindShaping::look_at_memory() noexcept {
  known_s_ = memory_.known_s();
  median_m_s_ = memory_.percentile(kMedian);
  strong_m_s_ = memory_.percentile(kStrong);
}

double WindShaping::site_gain_of(double mean_m_s) const noexcept {
  const SiteRange& site = settings_.site;
  if (site.median_m_s <= 0.0 || known_s_ <= 0.0) return 1.0;
  const double trusted_s = std::min(kKnownAfter_s, kKnownShare * settings_.site_memory_s);
  const double trust = std::min(1.0, known_s_ / trusted_s);
  const auto limited = [&site](double gain) { return std::clamp(gain, 1.0 / site.most_gain, site.most_gain); };

  // The gains of the two percentiles; between them the mean is interpolated.
  const double median_m_s = std::max(median_m_s_, kMinMedian_m_s);
  const double median_gain = limited(site.median_m_s / median_m_s);
  if (site.strong_m_s <= 0.0) return 1.0 + trust * (median_gain - 1.0);
  const double strong_m_s = std::max(strong_m_s_, 1.1 * median_m_s);
  const double strong_gain = limited(site.strong_m_s / strong_m_s);
  const double mean = std::clamp(mean_m_s, median_m_s, strong_m_s);
  const double part = (mean - median_m_s) / (strong_m_s - median_m_s);
  const double wanted_m_s = std::lerp(median_gain * median_m_s, strong_gain * strong_m_s, part);
  return 1.0 + trust * (wanted_m_s / mean - 1.0);
}

/// Advances each gain toward its target by the means and the opening hours.
void WindShaping::follow(double live_weight, bool is_open, double dt_s) noexcept {
  // The default wind is not the site's: it is configured.
  const double site_gain = 1.0 + live_weight * (site_gain_of(mean_.value) - 1.0);
  follow_to_the_end(site_, site_gain, settings_.over_s, dt_s);

  // A front counts before the slow mean has followed it.
  const double mean_m_s = std::max({mean_.value, quick_mean_.value / kFrontTimesMean, 0.0});
  const double floor_m_s = now_.floor_m_s;
  const double least_m_s = floor_m_s / kMaxFloorGain;
  const double site_mean_m_s = site_.value * mean_m_s;
  const double wanted_gain =
      floor_m_s > 0.0 ? std::clamp(floor_m_s / std::max(site_mean_m_s, least_m_s), 1.0, kMaxFloorGain) : 1.0;
  follow_to_the_end(floor_, wanted_gain, kFloorGainOver_s, dt_s);
  follow_to_the_end(breeze_, std::max(0.0, floor_m_s - kMaxFloorGain * site_mean_m_s), kFloorGainOver_s, dt_s);

  follow_to_the_end(opening_, is_open ? 1.0 : settings_.closed_level, settings_.fade_s, dt_s);
  follow_to_the_end(openness_, is_open ? 1.0 : 0.0, settings_.fade_s, dt_s);
}

/// Advances what is set by hand. A wind that begins is there at once, in no strength; one that replaces another turns
/// the shorter way. `way_s`: dt_s, but for the first call.
void WindShaping::follow_hand(const ByHand& by_hand, double dt_s, double way_s) noexcept {
  constexpr double kFullTurn_deg = 360.0;
  if (by_hand.wind) {
    if (hand_.value <= 0.0) {
      hand_m_s_ = {by_hand.wind->speed_m_s, 0.0};
      hand_from_deg_ = {by_hand.wind->direction_deg, 0.0};
      hand_turn_rad_ = 0.0;
    }
    const double turn_deg = within_half_a_turn(by_hand.wind->direction_deg - hand_from_deg_.value, kFullTurn_deg);
    hand_m_s_.step(by_hand.wind->speed_m_s, kPhaseOfArrival / kHandOver_s, dt_s);
    hand_from_deg_.step(hand_from_deg_.value + turn_deg, kPhaseOfArrival / kHandOver_s, dt_s);
  }
  follow_to_the_end(hand_, by_hand.wind ? 1.0 : 0.0, kHandOver_s, way_s);
  follow_to_the_end(dark_, by_hand.is_dark ? 1.0 : 0.0, kDarkOver_s, way_s);
}

/// Puts the wind by hand in the place of the others, as far as it is in effect: a mean that is the same everywhere, and
/// its own gusts, which it carries.
void WindShaping::apply_hand(ground::DrivingWind& wind, double dt_s) noexcept {
  const double part = part_of(hand_);
  if (part <= 0.0 && hand_way_m_ == 0.0) return;
  ground::Wind& ground = wind.ground;
  turbulence::GustNoise::Moment& gusts = ground.gusts;
  const double speed_m_s = std::max(0.0, hand_m_s_.value);
  const Vector ahead = wind_from(1.0, hand_from_deg_.value);

  hand_blown_m_ = hand_blown_m_ + (part * dt_s) * (speed_m_s * ahead - ground.advection);
  hand_way_m_ += part * dt_s * speed_m_s;
  noise_->carry(gusts.carried, hand_blown_m_.u_m_s, -hand_blown_m_.v_m_s, 1.0);
  carry_tapes(wind.stroke, hand_blown_m_, hand_way_m_);
  if (part <= 0.0) return;

  // The angle from the real direction to its own, counterclockwise; followed over any number of turns.
  const double cross = gusts.ahead.u_m_s * ahead.v_m_s - gusts.ahead.v_m_s * ahead.u_m_s;
  const double turn_rad = std::atan2(cross, dot(gusts.ahead, ahead));
  hand_turn_rad_ += within_half_a_turn(turn_rad - hand_turn_rad_, 2.0 * std::numbers::pi);
  const double cosine = std::cos(part * hand_turn_rad_);
  const double sine = std::sin(part * hand_turn_rad_);

  ground = (1.0 - part) * ground;
  ground.advection = (1.0 - part) * ground.advection + (part * speed_m_s) * ahead;
  const turbulence::GustNoise::Moment real = gusts;
  turbulence::GustNoise::Moment own = gusts;
  own.ahead = ahead;
  for (std::size_t i = 0; i < turbulence::GustNoise::kOctaves; ++i) {
    const double along_m_s = part * speed_m_s * std::sqrt(along_[i]);
    const double across_m_s = part * speed_m_s * std::sqrt(across_[i]);
    own.along_m_s[i] = static_cast<float>(along_m_s);
    own.across_m_s[i] = static_cast<float>(across_m_s);
    gusts.along_m_s[i] = static_cast<float>(math::length(static_cast<double>(gusts.along_m_s[i]), along_m_s));
    gusts.across_m_s[i] = static_cast<float>(math::length(static_cast<double>(gusts.across_m_s[i]), across_m_s));
  }
  gusts.ahead = {cosine * real.ahead.u_m_s - sine * real.ahead.v_m_s,
                 sine * real.ahead.u_m_s + cosine * real.ahead.v_m_s};
  know_less(wind.stroke, real, gusts);
  const Vector held = (part * speed_m_s) * ahead + noise_->everywhere(own);
  ground.breeze = ground.breeze + held;
  ground.everywhere = ground.everywhere + held;
  wind.state.wind = wind_where_measured(ground, wind.stroke, *noise_);
}

/// Adds the floor's breeze: a mean from the last wind direction, and its own gusts, which it carries. Their power is
/// the difference between a wind of the floor's strength and one without the breeze.
void WindShaping::add_breeze(ground::DrivingWind& wind, double dt_s) noexcept {
  const double breeze_m_s = std::clamp(breeze_.value, 0.0, now_.floor_m_s);
  if (breeze_m_s <= 0.0 && blown_m_.u_m_s == 0.0 && blown_m_.v_m_s == 0.0) return;
  ground::Wind& ground = wind.ground;
  turbulence::GustNoise::Moment& gusts = ground.gusts;
  blown_m_ = blown_m_ + breeze_m_s * dt_s * gusts.ahead;
  ground.advection = ground.advection + breeze_m_s * gusts.ahead;
  blown_way_m_ += breeze_m_s * dt_s;
  noise_->carry(gusts.carried, blown_m_.u_m_s, -blown_m_.v_m_s, 1.0);
  carry_tapes(wind.stroke, blown_m_, blown_way_m_);

  const double scale = opening_.value * std::sqrt(breeze_m_s * (2.0 * now_.floor_m_s - breeze_m_s));
  turbulence::GustNoise::Moment own = gusts;
  const turbulence::GustNoise::Moment real = gusts;
  for (std::size_t i = 0; i < turbulence::GustNoise::kOctaves; ++i) {
    const double along_m_s = scale * std::sqrt(along_[i]);
    const double across_m_s = scale * std::sqrt(across_[i]);
    own.along_m_s[i] = static_cast<float>(along_m_s);
    own.across_m_s[i] = static_cast<float>(across_m_s);
    gusts.along_m_s[i] = static_cast<float>(math::length(static_cast<double>(gusts.along_m_s[i]), along_m_s));
    gusts.across_m_s[i] = static_cast<float>(math::length(static_cast<double>(gusts.across_m_s[i]), across_m_s));
  }
  know_less(wind.stroke, real, gusts);
  const Vector breeze = opening_.value * breeze_m_s * gusts.ahead + noise_->everywhere(own);
  ground.breeze = ground.breeze + breeze;
  ground.everywhere = ground.everywhere + breeze;

  wind.state.wind = wind_where_measured(ground, wind.stroke, *noise_);
}

WindShapingReport WindShaping::report() const noexcept {
  return {.mean_m_s = mean_.value,
          .shaped_mean_m_s = site_.value * floor_.value * mean_.value + breeze_.value,
          .site_gain = site_.value,
          .floor_gain = floor_.value,
          .breeze_m_s = breeze_.value,
          .gusts = now_.gusts,
          .opening = opening_.value,
          .openness = openness_.value * (1.0 - part_of(dark_)),
          .hand = part_of(hand_),
          .speed_m_s = speed_m_s_,
          .ceiling_gain = ceiling_gain_,
          .median_m_s = median_m_s_,
          .strong_m_s = strong_m_s_,
          .known_s = known_s_};
}

}  // namespace yuragi::wind::shaping
