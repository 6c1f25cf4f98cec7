#include "engine/wind/blended_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

#include "engine/wind/wind_profile.hpp"

namespace yuragi {
namespace {

/// Gusts go on changing in calm air as if it moved at this.
constexpr double kLeastAdvection_m_s = 0.3;
/// Below this the wind's direction is no direction: what it was is held, the more the calmer it is.
constexpr double kCalm_m_s = 0.5;
constexpr double kTurnRate_hz = 0.1;

/// How fast two sensors disagree with their distance over the length of a gust (Davenport 1961: 10 to 16 sideways).
constexpr double kCoherenceDecay = 10.0;
/// Gusts of an absolute source tell something new after so many of its intervals.
constexpr double kIntervalsOfAGust = 3.0;
/// A low pass has done 98 % of its way after 4 time constants.
constexpr double kPlaneRateTimesHandover = 4.0;
/// Less than this is nothing.
constexpr double kLeastShare = 1e-9;
/// How fast the strength of the gusts follows what it should be.
constexpr double kStrengthMemory_s = 1.0;
/// A step of time of more than so many ticks, or steps like the one before, is a leap of the clock or a halt of the
/// machine: the wind goes on from where it was, and only the readings' ages are what they are.
constexpr double kLongestStep_ticks = 2.0;

double dot(WindVector a, WindVector b) noexcept {
  return a.u_m_s * b.u_m_s + a.v_m_s * b.v_m_s;
}

std::vector<BlendSourceSettings> completed(std::vector<BlendSourceSettings> sources, std::size_t count) {
  sources.resize(count);
  return sources;
}

}  // namespace

BlendedEstimator::BlendedEstimator(std::size_t source_count, const BlendSettings& settings,
                                   std::shared_ptr<const GustNoise> noise)
    : settings_(settings),
      climate_(wind_from(settings.climate.mean_speed_m_s, settings.climate.mean_direction_deg)),
      noise_(std::move(noise)),
      climate_along_(gust_variances(*noise_, settings.climate.turbulence_intensity, settings.length_m)),
      climate_across_(
          gust_variances(*noise_, kAcrossPerAlong * settings.climate.turbulence_intensity, settings.length_m)),
      choice_(completed(settings.sources, source_count), settings.handover_s, settings.return_after_s),
      plane_(completed(settings.sources, source_count)),
      shares_(source_count),
      level_shares_(source_count),
      place_weights_(source_count),
      responses_(source_count) {
  settings_.sources.resize(source_count);
  ground_.slope = plane_.ends();
  ground_.gusts.ahead = wind_from(1.0, settings.climate.mean_direction_deg);
  ground_.gusts.carried = noise_->begin(settings.climate.seed);
  sources_.reserve(source_count);
  for (const BlendSourceSettings& source : settings_.sources) sources_.emplace_back(settings, source, *noise_);
}

bool BlendedEstimator::accept(std::size_t index, const WindReading& reading) noexcept {
  if (index >= sources_.size()) return false;
  return sources_[index].accept(reading, {.ahead = ground_.gusts.ahead,
                                          .is_direction_live = is_direction_live(index),
                                          .advection_m_s = std::max(advection_m_s_, kLeastAdvection_m_s)});
}

/// Does another source measure the direction of the wind that is shown?
bool BlendedEstimator::is_direction_live(std::size_t besides) const noexcept {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (i == besides || !choice_.is_chosen(i) || choice_.word(i) < 0.5 * kLeastShare) continue;
    if (sources_[i].has_vane() && sources_[i].record().is_live(state_.time, settings_.stale_intervals)) return true;
  }
  return false;
}

/// What each source has of the mean and of each band.
void BlendedEstimator::share_out(double dt_s) noexcept {
  const double plane_part = -std::expm1(-kPlaneRateTimesHandover / settings_.handover_s * dt_s);
  for (std::size_t level = 0; level <= kBands; ++level) share_level(level, plane_part);
}

void BlendedEstimator::share_level(std::size_t level, double plane_part) noexcept {
  // Those who have the word: of what is known together, each has a part by weight times trust. What is known together
  // is the mean of their trusts, weighted in the same way: as much as the one knows who knows.
  double words = 0.0;
  double trusted = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const double trust = sources_[i].trust()[level];
    words += choice_.word(i);
    trusted += choice_.word(i) * trust;
    squares += choice_.word(i) * trust * trust;
  }
  const double scale = trusted > kLeastShare ? std::min(words, 1.0) * squares / (trusted * trusted) : 1.0;
  double known = 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    shares_[i].word[level] = level_shares_[i] = scale * choice_.word(i) * sources_[i].trust()[level];
    known += level_shares_[i];
  }

  // Their plane, less steep the less coherent their gusts are. A second place at once makes a slope, however small its
  // share: its weights follow as slowly as a hand-over.
  double part = 1.0;
  if (!plane_.is_point() && level > 0) {
    part = std::sqrt(davenport_coherence(OctaveFollower::centre_hz(level - 1), plane_.length_m(),
                                         std::max(advection_m_s_, kLeastAdvection_m_s), kCoherenceDecay));
  }
  plane_.weigh(level_shares_, part, place_weights_);

  // Relative sources have of the gusts what is left.
  const double left = level > 0 ? std::max(0.0, 1.0 - known) : 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    Share& share = shares_[i];
    share.tilt[level] += plane_part * (place_weights_[i].middle - level_shares_[i] - share.tilt[level]);
    share.per_m_east[level] += plane_part * (place_weights_[i].per_m_east - share.per_m_east[level]);
    share.per_m_south[level] += plane_part * (place_weights_[i].per_m_south - share.per_m_south[level]);
    const double filled = left * choice_.gusts(i) * sources_[i].trust()[level];
    share.middle[level] = level_shares_[i] + share.tilt[level] + filled;
  }
}

/// What a source says of the mean, or of a band.
WindVector BlendedEstimator::said(std::size_t index, std::size_t level) const noexcept {
  const BlendSource& source = sources_[index];
  const WindVector value = level == 0 ? source.mean() : source.band(level - 1);
  if (!settings_.sources[index].is_relative) return value;
  return (level == 0 ? source.scale.mean_gain() : source.scale.gust_gain()) * value;
}

/// How much stronger than they say relative sources are, from the absolute ones that have the word.
void BlendedEstimator::learn_scales(double dt_s) noexcept {
  for (std::size_t r = 0; r < sources_.size(); ++r) {
    if (!settings_.sources[r].is_relative || !sources_[r].record().is_live(state_.time, settings_.stale_intervals)) {
      continue;
    }
    RelativeScale::Pair pair{.relative_speed_m_s = sources_[r].speed_m_s()};
    double weight = 0.0;
    BandWeights common{};
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (settings_.sources[i].is_relative) continue;
      const BandWeights& word = shares_[i].word;
      weight += word[0];
      pair.speed_m_s += word[0] * sources_[i].speed_m_s();
      pair.independent_after_s += word[0] * kIntervalsOfAGust * sources_[i].record().expected_interval_s();
      for (std::size_t level = 1; level <= kBands; ++level) {
        pair.gust_m_s += word[level] * dot(said(i, level), ground_.gusts.ahead);
        common[level] += word[level] * sources_[i].passed()[level];
      }
    }
    if (weight < 0.5) continue;
    pair.speed_m_s /= weight;
    pair.independent_after_s = std::max(pair.independent_after_s / weight, 1.0);
    for (std::size_t level = 1; level <= kBands; ++level) {
      pair.relative_gust_m_s += common[level] * dot(sources_[r].band(level - 1), ground_.gusts.ahead);
    }
    sources_[r].scale.learn(pair, dt_s);
  }
}

BlendedEstimator::Heard BlendedEstimator::hear() noexcept {
  Heard heard;
  WindSlope& slope = ground_.slope;
  slope.per_m_east = slope.per_m_south = {};
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Share& share = shares_[i];
    const bool is_relative = settings_.sources[i].is_relative;
    heard.weight += share.middle[0];
    heard.mean = heard.mean + share.middle[0] * said(i, 0);
    heard.speed_m_s += share.middle[0] * sources_[i].speed_m_s() * (is_relative ? sources_[i].scale.mean_gain() : 1.0);
    for (std::size_t level = 0; level <= kBands; ++level) {
      const WindVector value = said(i, level);
      if (level > 0) heard.wind = heard.wind + share.middle[level] * value;
      slope.per_m_east = slope.per_m_east + share.per_m_east[level] * value;
      slope.per_m_south = slope.per_m_south + share.per_m_south[level] * value;
    }
  }
  heard.weight = std::clamp(heard.weight, 0.0, 1.0);
  heard.mean = heard.mean + (1.0 - heard.weight) * climate_;
  heard.wind = heard.wind + heard.mean;
  heard.speed_m_s = std::max(heard.speed_m_s, 0.0) + (1.0 - heard.weight) * settings_.climate.mean_speed_m_s;
  heard.trust = trust() * heard.weight;

  // Winds of this mean speed differ from end to end by twice as much at most.
  const double difference_m_s = speed_of(slope.per_m_east) * (slope.east_m - slope.west_m) +
                                speed_of(slope.per_m_south) * (slope.south_m - slope.north_m);
  if (const double most_m_s = 2.0 * heard.speed_m_s; difference_m_s > most_m_s) {
    slope.per_m_east = (most_m_s / difference_m_s) * slope.per_m_east;
    slope.per_m_south = (most_m_s / difference_m_s) * slope.per_m_south;
  }
  return heard;
}

/// Of the bands that those who have the word could know: 1 while they speak.
double BlendedEstimator::trust() const noexcept {
  double known = 0.0;
  double knowable = 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    for (std::size_t level = 1; level <= kBands; ++level) {
      known += choice_.word(i) * sources_[i].trust()[level];
      knowable += choice_.word(i) * sources_[i].full_trust()[level];
    }
  }
  return knowable > 0.0 ? std::clamp(known / std::max(knowable, known), 0.0, 1.0) : 0.0;
}

BlendedEstimator::Power BlendedEstimator::power_heard(double frequency_hz) noexcept {
  const OctaveFollower::Response bands(frequency_hz);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    responses_[i] = sources_[i].response(frequency_hz, bands, shares_[i].middle);
  }
  // Each with each: what two sources say adds up by amplitude as far as they are coherent, else by power.
  Power power;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    power.along += std::norm(responses_[i].along);
    power.across += std::norm(responses_[i].across);
    for (std::size_t j = 0; j < i; ++j) {
      double coherence = 2.0;
      if (!plane_.is_point()) {
        const BlendSourceSettings& a = settings_.sources[i];
        const BlendSourceSettings& b = settings_.sources[j];
        const double distance_m =
            a.is_relative || b.is_relative ? 0.0 : std::hypot(a.east_m - b.east_m, a.south_m - b.south_m);
        coherence *= davenport_coherence(frequency_hz, distance_m, advection_m_s_, kCoherenceDecay);
      }
      power.along += coherence * (responses_[i].along * std::conj(responses_[j].along)).real();
      power.across += coherence * (responses_[i].across * std::conj(responses_[j].across)).real();
    }
  }
  return {std::clamp(power.along, 0.0, 1.0), std::clamp(power.across, 0.0, 1.0)};
}

/// The mean wind carries the gusts, and says where ahead is; their eddies turn over as the turbulence does.
void BlendedEstimator::carry_gusts(const Heard& heard, double dt_s) noexcept {
  WindVector& ahead = ground_.gusts.ahead;
  const double speed_m_s = speed_of(heard.mean);
  if (speed_m_s > 0.0) {
    const double calm = std::clamp(speed_m_s / kCalm_m_s, 0.0, 1.0);
    const double part = -std::expm1(-2.0 * std::numbers::pi * kTurnRate_hz * calm * calm * dt_s);
    ahead = turned_toward(ahead, (1.0 / speed_m_s) * heard.mean, part);
  }
  advection_m_s_ = std::max(speed_m_s, kLeastAdvection_m_s);
  const Turbulence now = turbulence();
  const double turnover_m23_s = eddy_turnover_m23_s(now.intensity * heard.speed_m_s,
                                                    now.time_scale_s * std::max(heard.speed_m_s, kLeastSpeed_m_s));
  noise_->carry(ground_.gusts.carried, advection_m_s_ * ahead.u_m_s, -advection_m_s_ * ahead.v_m_s, dt_s,
                turnover_m23_s);
}

/// How much a source's turbulence counts at a frequency, over the square of the mean speed: its part of the mean; above
/// what the absolute ones know, that of the relative ones.
double BlendedEstimator::variance_share(std::size_t index, double frequency_hz, const Heard& heard) const noexcept {
  double gusts = 0.0;
  double unknown = 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    gusts += choice_.gusts(i);
    unknown += shares_[i].middle[0] * (1.0 - sources_[i].trust_at(frequency_hz));
  }
  const double own = shares_[index].middle[0];
  if (gusts < kLeastShare) return own;
  const double given = heard.weight > 0.0 ? std::clamp(unknown / heard.weight, 0.0, 1.0) : 0.0;
  const double kept = own * (1.0 - std::min(gusts, 1.0) * given);
  if (!settings_.sources[index].is_relative) return kept;
  const double strength =
      sources_[index].scale.gust_gain() * sources_[index].speed_m_s() / std::max(heard.speed_m_s, kLeastSpeed_m_s);
  return kept + heard.weight * choice_.gusts(index) * given * std::min(strength * strength, 4.0);
}

/// How strong each octave of the noise is: what the sensors leave of it.
void BlendedEstimator::weigh_gusts(const Heard& heard, double dt_s) noexcept {
  // A new fit, or another interval of a sensor, is a step that nobody shall see.
  const auto part = static_cast<float>(-std::expm1(-dt_s / kStrengthMemory_s));
  const double scale = heard.speed_m_s * heard.speed_m_s;
  for (std::size_t i = 0; i < kOctaves; ++i) {
    const double frequency_hz = centre_hz(noise_->octaves()[i], advection_m_s_);
    // What would jitter from one picture to the next is left out, by and by over the octave before.
    const double shown = std::clamp(std::log2(0.5 * settings_.rate_hz / frequency_hz), 0.0, 1.0);
    // Waves of a plane that run aslant pass more slowly than their length tells: what a tile's octave brings is lower
    // by about half an octave, and that is where it would come on top of what the sensors say.
    const bool is_way = i < 2 * GustNoise::kWayOctaves;
    const Power known = power_heard(is_way ? frequency_hz : frequency_hz / std::numbers::sqrt2);
    double variance_along = (1.0 - heard.weight) * climate_along_[i];
    double variance_across = (1.0 - heard.weight) * climate_across_[i];
    for (std::size_t index = 0; index < sources_.size(); ++index) {
      if (!sources_[index].record().has_spoken()) continue;
      const double share = variance_share(index, frequency_hz, heard);
      variance_along += share * sources_[index].along()[i];
      variance_across += share * sources_[index].across()[i];
    }
    const auto approach = [part](float& strength_m_s, double variance) {
      strength_m_s += part * (static_cast<float>(std::sqrt(std::max(variance, 0.0))) - strength_m_s);
    };
    approach(ground_.gusts.along_m_s[i], shown * (1.0 - known.along) * scale * variance_along);
    approach(ground_.gusts.across_m_s[i], shown * (1.0 - known.across) * scale * variance_across);
  }
}

WindState BlendedEstimator::advance(MonoTime now) noexcept {
  const bool is_first = !has_begun_;
  if (is_first) {
    has_begun_ = true;
    state_.time = now;
  }
  if (now < state_.time) return state_;
  const double passed_s = seconds(now - state_.time);
  const double dt_s = std::min(passed_s, kLongestStep_ticks * std::max(1.0 / settings_.rate_hz, last_step_s_));
  last_step_s_ = passed_s;
  state_.time = now;

  // Who has the word, and what each says.
  const OctaveFollower::Parts parts = OctaveFollower::parts(dt_s);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    choice_.set_live(i, sources_[i].record().is_live(now, settings_.stale_intervals));
  }
  choice_.step(dt_s);
  for (BlendSource& source : sources_) {
    if (source.record().has_spoken()) source.step(now, dt_s, parts);
  }
  share_out(dt_s);
  learn_scales(dt_s);

  // The wind: what is heard, and the gusts for the rest.
  const Heard heard = hear();
  carry_gusts(heard, dt_s);
  weigh_gusts(heard, is_first ? std::numeric_limits<double>::infinity() : dt_s);
  ground_.everywhere = heard.wind + noise_->everywhere(ground_.gusts);
  state_.wind = ground_.at(*noise_, 0.0, 0.0);
  if (const double speed_m_s = speed_of(state_.wind); speed_m_s > kMaxPlausibleSpeed_m_s) {
    state_.wind = (kMaxPlausibleSpeed_m_s / speed_m_s) * state_.wind;
  }

  state_.live_weight = heard.trust;
  state_.reading_age_s = newest_age_s();
  state_.source = heard.trust > 0.99   ? WindSource::kLive
                  : heard.trust < 0.01 ? WindSource::kDefault
                                       : WindSource::kHandover;
  return state_;
}

/// Of the readings that take part; 0 where none does.
double BlendedEstimator::newest_age_s() const noexcept {
  std::optional<double> newest_s;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (!choice_.is_chosen(i)) continue;
    const double age_s = sources_[i].record().age_s(state_.time);
    newest_s = std::min(newest_s.value_or(age_s), age_s);
  }
  return newest_s.value_or(0.0);
}

SourceReport BlendedEstimator::report(std::size_t index) const noexcept {
  if (index >= sources_.size()) return {};
  return sources_[index].record().report(state_.time, settings_.stale_intervals);
}

Turbulence BlendedEstimator::turbulence() const noexcept {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (choice_.word(i) >= 0.5) return sources_[i].turbulence();
  }
  return {settings_.climate.turbulence_intensity,
          settings_.length_m / std::max(settings_.climate.mean_speed_m_s, kLeastSpeed_m_s)};
}

}  // namespace yuragi
