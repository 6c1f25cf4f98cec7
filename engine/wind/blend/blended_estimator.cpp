#include "engine/wind/blend/blended_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

namespace yuragi::wind::blend {
namespace {

/// In calm air gusts still change as if it moved at this speed.
constexpr double kMinAdvection_m_s = 0.3;
/// Below this speed the direction is unreliable; the previous one is held, more strongly the calmer it is.
constexpr double kCalm_m_s = 0.5;
constexpr double kTurnRate_hz = 0.1;

/// Gusts of an absolute source are independent after this many of its intervals.
constexpr double kIntervalsOfAGust = 3.0;
/// A low pass has done 98 % of its way after 4 time constants.
constexpr double kPlaneRateTimesHandover = 4.0;
/// Sources have at least this weight at their own place.
constexpr double kMinWeight = 1e-6;
/// Shares below this count as zero.
constexpr double kMinShare = 1e-9;
/// The time constant with which the strength of the gusts follows its target.
constexpr double kStrengthMemory_s = 1.0;
/// And that with which their coherence follows the fitted turbulence.
constexpr double kCoherenceMemory_s = 10.0;
/// The noise's eddies turn over at half of their own rate. At the full rate two places 60 m apart along the wind have
/// less in common than GustCoherence predicts from measurements; with frozen noise they have more.
constexpr double kTurnoverRate = 0.5;
/// Waves shorter than this many of its samples are faded out of the tape, over the octave above them.
constexpr double kMinSamplesAWave = 4.0;
/// The speed at which the windward edge moves to a wider reach, relative to the wind's.
constexpr double kReachRate = 0.2;
/// A longer step of time, in ticks or in previous steps, is a jump of the clock or a halt of the machine: the wind
/// continues from its last state, and only the readings' ages change.
constexpr double kMaxStep_ticks = 2.0;

/// The number of octaves by which a ratio is above 1, limited to 0 to 1.
double part_of_octave(double ratio) noexcept {
  if (ratio <= 1.0) return 0.0;
  return ratio >= 2.0 ? 1.0 : std::log2(ratio);
}

std::vector<SourceSettings> completed(std::vector<SourceSettings> sources, std::size_t count) {
  sources.resize(count);
  return sources;
}

}  // namespace

BlendedEstimator::BlendedEstimator(std::size_t source_count, const Settings& settings,
                                   std::shared_ptr<const turbulence::GustNoise> noise)
    : settings_(settings),
      climate_(wind_from(settings.climate.mean_speed_m_s, settings.climate.mean_direction_deg)),
      noise_(std::move(noise)),
      climate_along_(turbulence::gust_variances(*noise_, settings.climate.turbulence_intensity, settings.length_m)),
      climate_across_(turbulence::gust_variances(
          *noise_, turbulence::kAcrossPerAlong * settings.climate.turbulence_intensity, settings.length_m)),
      choice_(completed(settings.sources, source_count), settings.handover_s, settings.return_after_s),
      plane_(completed(settings.sources, source_count)),
      places_(completed(settings.sources, source_count)),
      pens_(places_.count(),
            Pen{.shares = std::vector<BandWeights>(source_count), .written = std::vector<BandWeights>(source_count)}),
      reach_fit_(places_.count()),
      shares_(source_count),
      weights_(source_count),
      level_shares_(source_count),
      place_weights_(source_count),
      measured_places_(places_.count()),
      passed_(source_count),
      folded_(source_count) {
  settings_.sources.resize(source_count);
  ground_.slope = plane_.ends();
  ground_.gusts.ahead = wind_from(1.0, settings.climate.mean_direction_deg);
  ground_.gusts.carried = noise_->begin(settings.climate.seed);
  ground_.gusts.gustiness = static_cast<float>(settings.gustiness);
  ground_.gusts.fronts = turbulence::kFronts;
  stroke_.pen_count = pens_.size();
  stroke_.coherence.longest_wave_m =
      2.0 * std::numbers::pi /
      noise_->octaves()[turbulence::GustNoise::kFirstTileOctave + turbulence::GustNoise::kTileOctaves].from_rad_m;
  sources_.reserve(source_count);
  for (const SourceSettings& source : settings_.sources) sources_.emplace_back(settings, source, *noise_);
}

bool BlendedEstimator::accept(std::size_t index, const Reading& reading) noexcept {
  if (index >= sources_.size()) return false;
  return sources_[index].accept(reading, {.ahead = ground_.gusts.ahead,
                                          .is_direction_live = is_direction_live(index),
                                          .advection_m_s = std::max(advection_m_s_, kMinAdvection_m_s)});
}

void BlendedEstimator::list_state(StatePass& pass) {
  pass.grown(std::span(sources_));
  pass(choice_, reach_fit_, ground_, stroke_, advection_m_s_, state_, reach_m_, has_begun_);
  pass.grown(std::span(shares_));
  pass.total(last_step_s_);
  if (settings_.site) pass(*settings_.site);
}

TakenValue BlendedEstimator::taken(std::size_t source) const noexcept {
  return source < sources_.size() ? sources_[source].taken() : TakenValue{};
}

bool BlendedEstimator::is_direction_live(std::size_t besides) const noexcept {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (i == besides || !choice_.is_chosen(i) || choice_.weight(i) < 0.5 * kMinShare) continue;
    if (sources_[i].has_vane() && sources_[i].record().is_live(state_.time, settings_.stale_intervals)) return true;
  }
  return false;
}

/// The shares of each source in the mean and in each band.
void BlendedEstimator::share_out(double dt_s) noexcept {
  share_bands();
  share_mean(dt_s);
  for (std::size_t pen = 0; pen < pens_.size(); ++pen) share_at(pen);
}

/// The shares of the sources in a band, by weight times trust; their sum is the mean of the trusts, weighted in the
/// same way, so that sources that do not resolve the band take nothing from one that does (engine/wind/model.md W23).
/// Returns the sum of the shares.
double BlendedEstimator::share_level(std::size_t level, std::span<const double> weights,
                                     std::span<double> shares) const noexcept {
  double all = 0.0;
  double trusted = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const double trust = sources_[i].trust()[level];
    all += weights[i];
    trusted += weights[i] * trust;
    squares += weights[i] * trust * trust;
  }
  const double scale = trusted > kMinShare ? std::min(all, 1.0) * squares / (trusted * trusted) : 1.0;
  double known = 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    shares[i] = scale * weights[i] * sources_[i].trust()[level];
    known += shares[i];
  }
  return known;
}

/// The shares among all sources, at all places.
void BlendedEstimator::share_bands() noexcept {
  for (std::size_t i = 0; i < sources_.size(); ++i) weights_[i] = choice_.weight(i);
  for (std::size_t level = 0; level <= kBands; ++level) {
    share_level(level, weights_, level_shares_);
    for (std::size_t i = 0; i < sources_.size(); ++i) shares_[i].weights[level] = level_shares_[i];
  }
}

/// The means form a plane. A second place adds a slope immediately, even with a small share: so the plane's weights
/// follow at the rate of a hand-over.
void BlendedEstimator::share_mean(double dt_s) noexcept {
  const double plane_part = -std::expm1(-kPlaneRateTimesHandover / settings_.handover_s * dt_s);
  for (std::size_t i = 0; i < sources_.size(); ++i) level_shares_[i] = shares_[i].weights[0];
  plane_.weigh(level_shares_, 1.0, place_weights_);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    Share& share = shares_[i];
    share.tilt += plane_part * (place_weights_[i].middle - share.weights[0] - share.tilt);
    share.per_m_east += plane_part * (place_weights_[i].per_m_east - share.per_m_east);
    share.per_m_south += plane_part * (place_weights_[i].per_m_south - share.per_m_south);
    share.middle = share.weights[0] + share.tilt;
  }
}

/// The shares in the bands at one place: the sources at this place share all of them, even if their weight among others
/// is small; the pen's presence is the weight of the place. Relative sources get the remaining gusts.
void BlendedEstimator::share_at(std::size_t index) noexcept {
  Pen& pen = pens_[index];
  double all = 0.0;
  pen.weight = 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    all += choice_.weight(i);
    if (places_.pen_of(i) == index) pen.weight += choice_.weight(i);
  }
  // If none of them is selected at present, they are still written, so that nothing jumps when one is selected.
  const double own = pens_.size() == 1 ? 0.0 : kMinWeight;
  const double sum = pen.weight + own * static_cast<double>(places_.sources_at(index));
  const double times = sum > kMinShare ? all / sum : 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    weights_[i] = places_.pen_of(i) == index ? times * (choice_.weight(i) + own) : 0.0;
    pen.shares[i][0] = shares_[i].middle;
  }
  for (std::size_t level = 1; level <= kBands; ++level) {
    const double left = std::max(0.0, 1.0 - share_level(level, weights_, level_shares_));
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      pen.shares[i][level] = level_shares_[i] + left * choice_.gusts(i) * sources_[i].trust()[level];
    }
  }
}

/// A source's mean (level 0) or band, with the gain of a relative one.
Vector BlendedEstimator::level_of(std::size_t index, std::size_t level) const noexcept {
  const SourceEstimator& source = sources_[index];
  const Vector value = level == 0 ? source.mean() : source.band(level - 1);
  if (!settings_.sources[index].is_relative) return value;
  return (level == 0 ? source.scale.mean_gain() : source.scale.gust_gain()) * value;
}

/// Updates the gains of relative sources, from the selected absolute ones.
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
      const BandWeights& weights = shares_[i].weights;
      weight += weights[0];
      pair.speed_m_s += weights[0] * sources_[i].speed_m_s();
      pair.independent_after_s += weights[0] * kIntervalsOfAGust * sources_[i].record().expected_interval_s();
      for (std::size_t level = 1; level <= kBands; ++level) {
        pair.gust_m_s += weights[level] * dot(level_of(i, level), ground_.gusts.ahead);
        common[level] += weights[level] * sources_[i].passed()[level];
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

BlendedEstimator::MeasuredMean BlendedEstimator::measure_mean() noexcept {
  MeasuredMean measured;
  ground::WindSlope& slope = ground_.slope;
  slope.per_m_east = slope.per_m_south = {};
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Share& share = shares_[i];
    const bool is_relative = settings_.sources[i].is_relative;
    const Vector mean = level_of(i, 0);
    measured.weight += share.middle;
    measured.mean = measured.mean + share.middle * mean;
    measured.speed_m_s += share.middle * sources_[i].speed_m_s() * (is_relative ? sources_[i].scale.mean_gain() : 1.0);
    slope.per_m_east = slope.per_m_east + share.per_m_east * mean;
    slope.per_m_south = slope.per_m_south + share.per_m_south * mean;
  }
  measured.weight = std::clamp(measured.weight, 0.0, 1.0);
  measured.mean = measured.mean + (1.0 - measured.weight) * climate_;
  measured.speed_m_s = std::max(measured.speed_m_s, 0.0) + (1.0 - measured.weight) * settings_.climate.mean_speed_m_s;
  measured.trust = trust() * measured.weight;

  // The difference of the wind from end to end is at most twice this mean speed.
  const double difference_m_s = speed_of(slope.per_m_east) * (slope.east_m - slope.west_m) +
                                speed_of(slope.per_m_south) * (slope.south_m - slope.north_m);
  if (const double most_m_s = 2.0 * measured.speed_m_s; difference_m_s > most_m_s) {
    slope.per_m_east = (most_m_s / difference_m_s) * slope.per_m_east;
    slope.per_m_south = (most_m_s / difference_m_s) * slope.per_m_south;
  }
  return measured;
}

/// The part of the bands that the selected sources can resolve: 1 while their readings are on time.
double BlendedEstimator::trust() const noexcept {
  double known = 0.0;
  double knowable = 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    for (std::size_t level = 1; level <= kBands; ++level) {
      known += choice_.weight(i) * sources_[i].trust()[level];
      knowable += choice_.weight(i) * sources_[i].full_trust()[level];
    }
  }
  return knowable > 0.0 ? std::clamp(known / std::max(knowable, known), 0.0, 1.0) : 0.0;
}

/// Sources at one place add up by amplitude; aliased power adds up by power (W40).
BlendedEstimator::Power BlendedEstimator::measured_power(const turbulence::OctaveFollower::Response& bands,
                                                         std::span<const BandWeights> shares) const noexcept {
  SourceResponse sum;
  Power folded;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const std::complex<double> in_bands = bands.weighted(shares[i]);
    const std::complex<double> along = passed_[i].along * in_bands;
    const std::complex<double> across = passed_[i].across * in_bands;
    sum.along += along;
    sum.across += across;
    folded.along += folded_[i] * std::norm(along);
    folded.across += folded_[i] * std::norm(across);
  }
  return {std::clamp(std::norm(sum.along) + folded.along, 0.0, 1.0),
          std::clamp(std::norm(sum.across) + folded.across, 0.0, 1.0)};
}

/// The mean wind carries the gusts, and sets the downwind direction; their eddies turn over according to the
/// turbulence.
void BlendedEstimator::carry_gusts(const MeasuredMean& measured, double dt_s) noexcept {
  Vector& ahead = ground_.gusts.ahead;
  const double speed_m_s = speed_of(measured.mean);
  if (speed_m_s > 0.0) {
    const double calm = std::clamp(speed_m_s / kCalm_m_s, 0.0, 1.0);
    const double part = -std::expm1(-2.0 * std::numbers::pi * kTurnRate_hz * calm * calm * dt_s);
    ahead = turned_toward(ahead, (1.0 / speed_m_s) * measured.mean, part);
  }
  advection_m_s_ = std::max(speed_m_s, kMinAdvection_m_s);
  const turbulence::Turbulence now = turbulence();
  const double length_m = now.time_scale_s * std::max(measured.speed_m_s, kMinSpeed_m_s);
  ground_.advection = advection_m_s_ * ahead;
  noise_->carry(ground_.gusts.carried, ground_.advection.u_m_s, -ground_.advection.v_m_s, dt_s,
                kTurnoverRate * turbulence::eddy_turnover_m23_s(now.intensity * measured.speed_m_s, length_m));

  // The tapes go the same way.
  const double way_m = advection_m_s_ * dt_s;
  stroke_.way_m += way_m;
  stroke_.carried_east_m += way_m * ahead.u_m_s;
  stroke_.carried_south_m -= way_m * ahead.v_m_s;
  stroke_.ahead = ahead;
  ground::GustCoherence& coherence = stroke_.coherence;
  const double part = is_first_ ? 1.0 : -std::expm1(-dt_s / kCoherenceMemory_s);
  coherence.speed_m_s = advection_m_s_;
  coherence.length_m = gust_length_m(measured);
  const double decay_along = ground::GustCoherence::decay_along_of(now.intensity) * std::exp(-reach().along_ln);
  const double decay_across = ground::GustCoherence::decay_across_of(now.intensity) * std::exp(-reach().across_ln);
  coherence.decay_along += part * (decay_along - coherence.decay_along);
  coherence.decay_across += part * (decay_across - coherence.decay_across);
  reach_m_ += std::clamp(settings_.reach_m - reach_m_, -kReachRate * way_m, kReachRate * way_m);
}

/// The configured integral length scale, for the coherence law: a fit to fast readings determines it poorly.
double BlendedEstimator::gust_length_m(const MeasuredMean& measured) const noexcept {
  double length_m = (1.0 - measured.weight) * settings_.length_m;
  double all = 1.0 - measured.weight;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const double own_m = settings_.sources[i].length_m;
    const double share = std::max(shares_[i].middle, 0.0);
    length_m += share * (own_m > 0.0 ? own_m : settings_.length_m);
    all += share;
  }
  return length_m / all;
}

/// The place of each pen (at the windward edge of the scenes, or at its sensor), the weight of its sensors, and its
/// part of the wind that is shown.
void BlendedEstimator::place_pens() noexcept {
  double largest = kMinShare;
  double all = 0.0;
  for (const Pen& pen : pens_) {
    largest = std::max(largest, pen.weight);
    all += pen.weight;
  }
  const Vector ahead = stroke_.ahead;
  for (std::size_t i = 0; i < pens_.size(); ++i) {
    const PenPlaces::Place& place = places_.place(i);
    const double upwind_m = place.is_edge ? reach_m_ : place.lead_m;
    ground::WindPen& pen = stroke_.pens[i];
    pen.east_m = place.east_m - upwind_m * ahead.u_m_s;
    pen.south_m = place.south_m + upwind_m * ahead.v_m_s;
    pen.part = all > kMinShare ? pens_[i].weight / all : 1.0 / static_cast<double>(pens_.size());
    pen.presence = std::clamp(2.0 * pens_[i].weight / largest, 0.0, 1.0);
    pen.now.east_m = pen.east_m - stroke_.carried_east_m;
    pen.now.south_m = pen.south_m - stroke_.carried_south_m;
  }
}

/// The measured wind at each place, limited to the waves that the tape can hold.
void BlendedEstimator::write_gusts() noexcept {
  is_fading_ = false;
  for (std::size_t band = 0; band < kBands; ++band) {
    const double wave_m = advection_m_s_ / turbulence::OctaveFollower::centre_hz(band);
    fade_[1 + band] = part_of_octave(wave_m / (kMinSamplesAWave * ground::WindTape::kStep_m));
  }
  for (std::size_t p = 0; p < pens_.size(); ++p) {
    ground::WindPen& pen = stroke_.pens[p];
    pen.weights.fill(0.0);
    for (std::size_t level = 0; level <= kBands; ++level) {
      Vector gust;
      for (std::size_t i = 0; i < sources_.size(); ++i) {
        const double share = pens_[p].shares[i][level];
        const double written = share * (level == 0 ? 1.0 : fade_[level]);
        pens_[p].written[i][level] = written;
        pen.weights[level] += written;
        if (level > 0 && share > 0.0) gust = gust + share * level_of(i, level);
      }
      if (level == 0) continue;
      if (pen.weights[level] > kMinShare && fade_[level] < 1.0) is_fading_ = true;
      pen.now.east_m_s[level - 1] = static_cast<float>(gust.u_m_s);
      pen.now.north_m_s[level - 1] = static_cast<float>(gust.v_m_s);
    }
  }
}

/// From measurements at configured places.
void BlendedEstimator::learn_reach(double dt_s) noexcept {
  if (pens_.size() < 2) return;
  for (std::size_t p = 0; p < pens_.size(); ++p) {
    const PenPlaces::Place& place = places_.place(p);
    double delay_s = 0.0;
    double all = kMinShare;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (places_.pen_of(i) != p) continue;
      const double weight = choice_.weight(i) + kMinWeight;
      delay_s += weight * sources_[i].reading_delay_s();
      all += weight;
    }
    measured_places_[p] = {.east_m = place.east_m,
                           .south_m = place.south_m,
                           .delay_s = delay_s / all,
                           .pen = place.is_edge ? nullptr : &stroke_.pens[p]};
  }
  reach_fit_.advance(dt_s, stroke_, measured_places_);
}

/// The part of a frequency that all sources together do not resolve.
BlendedEstimator::OpenPart BlendedEstimator::open_part(double frequency_hz,
                                                       const MeasuredMean& measured) const noexcept {
  OpenPart open;
  double unknown = 0.0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    open.gusts += choice_.gusts(i);
    unknown += shares_[i].middle * (1.0 - sources_[i].trust_at(frequency_hz));
  }
  if (measured.weight > 0.0) open.given = std::clamp(unknown / measured.weight, 0.0, 1.0);
  return open;
}

/// The weight of a source's turbulence at a frequency, over the square of the mean speed: its share in the mean; above
/// the frequencies that absolute sources resolve, that of the relative ones.
double BlendedEstimator::variance_share(std::size_t index, const OpenPart& open,
                                        const MeasuredMean& measured) const noexcept {
  const double own = shares_[index].middle;
  if (open.gusts < kMinShare) return own;
  const double kept = own * (1.0 - std::min(open.gusts, 1.0) * open.given);
  if (!settings_.sources[index].is_relative) return kept;
  const double strength =
      sources_[index].scale.gust_gain() * sources_[index].speed_m_s() / std::max(measured.speed_m_s, kMinSpeed_m_s);
  return kept + measured.weight * choice_.gusts(index) * open.given * std::min(strength * strength, 4.0);
}

/// The strength of each octave of the noise, and the part of it that the sensors measure (engine/wind/model.md W20).
/// The way's octaves are reduced by that part here; those of the tiles at each place.
void BlendedEstimator::weigh_gusts(const MeasuredMean& measured, double dt_s) noexcept {
  // A new fit, or a new interval of a sensor, is a step, which must not show.
  const auto part = static_cast<float>(is_first_ ? 1.0 : -std::expm1(-dt_s / kStrengthMemory_s));
  for (std::size_t i = 0; i < kOctaves; ++i) weigh_octave(i, measured, part);
}

void BlendedEstimator::weigh_octave(std::size_t octave, const MeasuredMean& measured, float part) noexcept {
  const double frequency_hz = turbulence::centre_hz(noise_->octaves()[octave], advection_m_s_);
  // Waves that would jitter from frame to frame are faded out over the octave before.
  const double shown = part_of_octave(0.5 * settings_.rate_hz / frequency_hz);
  double variance_along = (1.0 - measured.weight) * climate_along_[octave];
  double variance_across = (1.0 - measured.weight) * climate_across_[octave];
  const OpenPart open = open_part(frequency_hz, measured);
  for (std::size_t index = 0; index < sources_.size(); ++index) {
    if (!sources_[index].record().has_reading()) continue;
    const double share = variance_share(index, open, measured);
    variance_along += share * sources_[index].along()[octave];
    variance_across += share * sources_[index].across()[octave];
  }
  const double scale = shown * measured.speed_m_s * measured.speed_m_s;
  const auto approach = [part](float& value, double wanted) { value += part * (static_cast<float>(wanted) - value); };
  const auto deviation = [scale](double variance) { return std::sqrt(std::max(scale * variance, 0.0)); };
  float& along_m_s = ground_.gusts.along_m_s[octave];
  float& across_m_s = ground_.gusts.across_m_s[octave];

  // Waves of a plane that run at an angle pass more slowly than their length suggests: the frequencies of a tile's
  // octave are lower by about half an octave, and there it would add to what the sensors measure.
  const bool is_way = octave < turbulence::GustNoise::kFirstTileOctave;
  const double known_hz = is_way ? frequency_hz : frequency_hz / std::numbers::sqrt2;
  const turbulence::OctaveFollower::Response bands(known_hz);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    passed_[i] = sources_[i].passed_of(known_hz);
    folded_[i] = sources_[i].folded_over_own(known_hz);
  }
  if (is_way) {
    Power known;
    for (std::size_t p = 0; p < pens_.size(); ++p) {
      const Power here = measured_power(bands, pens_[p].shares);
      known.along += stroke_.pens[p].part * here.along;
      known.across += stroke_.pens[p].part * here.across;
    }
    approach(along_m_s, deviation((1.0 - known.along) * variance_along));
    approach(across_m_s, deviation((1.0 - known.across) * variance_across));
    return;
  }

  approach(along_m_s, deviation(variance_along));
  approach(across_m_s, deviation(variance_across));
  const std::size_t lane = octave - turbulence::GustNoise::kFirstTileOctave;
  stroke_.octave_hz[lane] = static_cast<float>(known_hz);
  for (std::size_t p = 0; p < pens_.size(); ++p) {
    const Power now = measured_power(bands, pens_[p].shares);
    const Power written = is_fading_ ? measured_power(bands, pens_[p].written) : now;
    ground::WindPen& pen = stroke_.pens[p];
    approach(pen.now.known_along[lane], now.along);
    approach(pen.now.known_across[lane], now.across);
    approach(pen.written.known_along[lane], written.along);
    approach(pen.written.known_across[lane], written.across);
  }
}

turbulence::GustNoise::Moment BlendedEstimator::gusts_at(std::size_t pen) const noexcept {
  return ground_.left_of(ground::WindTapes::at_pen(stroke_.pens[pen].now));
}

/// The wind that is shown, and the samples that go onto the tapes.
void BlendedEstimator::show(const MeasuredMean& measured) noexcept {
  const Vector way = noise_->everywhere(ground_.gusts);
  ground_.everywhere = measured.mean + way;
  state_.upwind_m = 0.0;
  double configured = 0.0;
  for (std::size_t p = 0; p < pens_.size(); ++p) {
    ground::WindPen& pen = stroke_.pens[p];
    if (!places_.place(p).is_edge) configured += pen.part;
    pen.now.mean = measured.mean;
    pen.now.way = way;
    const ground::OctaveLanes known_along = pen.written.known_along;
    const ground::OctaveLanes known_across = pen.written.known_across;
    pen.written = pen.now;
    pen.written.known_along = known_along;
    pen.written.known_across = known_across;
    for (std::size_t band = 0; band < kBands; ++band) {
      pen.written.east_m_s[band] *= static_cast<float>(fade_[1 + band]);
      pen.written.north_m_s[band] *= static_cast<float>(fade_[1 + band]);
    }
    ground_.everywhere = ground_.everywhere + pen.part * ground::WindTapes::at_pen(pen.now).gusts;
    state_.upwind_m -= pen.part * (pen.east_m * stroke_.ahead.u_m_s - pen.south_m * stroke_.ahead.v_m_s);
  }
  state_.wind = wind_where_measured(ground_, stroke_, *noise_);
  state_.is_place_configured = configured > 0.5;
  state_.to_middle_s = std::max(state_.upwind_m, 0.0) / advection_m_s_;
  if (const double speed_m_s = speed_of(state_.wind); speed_m_s > kMaxPlausibleSpeed_m_s) {
    state_.wind = (kMaxPlausibleSpeed_m_s / speed_m_s) * state_.wind;
  }
}

State BlendedEstimator::advance(MonoTime now) noexcept {
  is_first_ = !has_begun_;
  if (is_first_) {
    has_begun_ = true;
    reach_m_ = settings_.reach_m;
    state_.time = now;
  }
  if (now < state_.time) return state_;
  const double passed_s = seconds(now - state_.time);
  const double dt_s = std::min(passed_s, kMaxStep_ticks * std::max(1.0 / settings_.rate_hz, last_step_s_));
  last_step_s_ = passed_s;
  state_.time = now;

  // The weights of the sources, and their bands.
  const turbulence::OctaveFollower::Parts parts = turbulence::OctaveFollower::parts(dt_s);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    choice_.set_live(i, sources_[i].record().is_live(now, settings_.stale_intervals));
  }
  choice_.step(dt_s);
  for (SourceEstimator& source : sources_) {
    if (source.record().has_reading()) source.step(now, dt_s, parts);
  }
  share_out(dt_s);
  learn_scales(dt_s);

  // The wind: the measured part, and gusts for the rest.
  const MeasuredMean measured = measure_mean();
  carry_gusts(measured, dt_s);
  place_pens();
  write_gusts();
  learn_reach(dt_s);
  weigh_gusts(measured, dt_s);
  show(measured);

  state_.live_weight = measured.trust;
  state_.reading_age_s = newest_age_s();
  state_.source = measured.trust > 0.99 ? Source::kLive : measured.trust < 0.01 ? Source::kDefault : Source::kHandover;
  return state_;
}

/// Of the readings that are used; 0 if there are none.
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

turbulence::Turbulence BlendedEstimator::turbulence() const noexcept {
  double left = 1.0;
  turbulence::Turbulence sum{.intensity = 0.0, .time_scale_s = 0.0};
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const double weight = std::min(choice_.weight(i), left);
    left -= weight;
    sum.intensity += weight * sources_[i].turbulence().intensity;
    sum.time_scale_s += weight * sources_[i].turbulence().time_scale_s;
  }
  sum.intensity += left * settings_.climate.turbulence_intensity;
  sum.time_scale_s += left * settings_.length_m / std::max(settings_.climate.mean_speed_m_s, kMinSpeed_m_s);
  return sum;
}

}  // namespace yuragi::wind::blend
