#include "tests/proof/blend_comparison.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <span>
#include <thread>

#include "engine/wind/blend/blended_estimator.hpp"

namespace yuragi::proof {
namespace {

constexpr double kSegment_s = 1080.0;
/// The crossover times the interval, as the estimator has it.
constexpr double kCrossover = 0.25;

double sinc(double x) {
  const double angle = std::numbers::pi * x;
  return std::abs(angle) < 1e-6 ? 1.0 : std::sin(angle) / angle;
}

/// What a cut through the gusts' tiles should have, octave by octave. In the plane an octave has waves of k0 to 2 k0,
/// their power per area of wavenumbers falling as k^(-8/3); a cut along the wind sees of each wave the wavenumber along
/// it: E(k) = 2 times the integral over those across. Tiles are read bilinearly, which leaves sinc^4 of each axis of
/// the power of a wave, and spreads the rest over frequencies beyond those of the tile; reckoned for all directions
/// alike.
class TileCuts {
 public:
  explicit TileCuts(const wind::turbulence::GustNoise& noise) : noise_(noise) {
    for (std::size_t i = 0; i < cuts_.size(); ++i) {
      cuts_[i] = cut(from_rad_m(i) * noise.sample_m(i) / (2.0 * std::numbers::pi));
    }
  }

  /// Adds to a density in steps of step_hz, from kToHz on, what the gusts of a moment should have that pass at this
  /// speed, times a weight.
  void add(const wind::turbulence::GustNoise::Moment& gusts, double speed_m_s, double step_hz,
           std::vector<double>& density, double weight) const {
    for (std::size_t i = 0; i < cuts_.size(); ++i) {
      const auto along_m_s = static_cast<double>(gusts.along_m_s[wind::turbulence::GustNoise::kFirstTileOctave + i]);
      const auto across_m_s = static_cast<double>(gusts.across_m_s[wind::turbulence::GustNoise::kFirstTileOctave + i]);
      const double variance = along_m_s * along_m_s + across_m_s * across_m_s;
      const double unit_hz = from_rad_m(i) * speed_m_s / (2.0 * std::numbers::pi);
      for (auto k = static_cast<std::size_t>(kToHz / step_hz); k < density.size(); ++k) {
        const double place = 0.5 * static_cast<double>(k) * step_hz / unit_hz * static_cast<double>(kPoints);
        if (place >= static_cast<double>(kPoints)) break;
        density[k] += weight * variance * cuts_[i][static_cast<std::size_t>(place)] / unit_hz;
      }
    }
  }

 private:
  static constexpr std::size_t kPoints = 256;
  using Cut = std::array<double, kPoints>;  ///< one-sided density at k / k0 from 0 to 2, of variance 1

  double from_rad_m(std::size_t tile_octave) const {
    return noise_.octaves()[wind::turbulence::GustNoise::kFirstTileOctave + tile_octave].from_rad_m;
  }

  /// Of an octave whose longest waves have `cycles` a sample.
  static Cut cut(double cycles) {
    // What reading leaves at k / k0 from 1 to 2: of the wave itself, and of all variance (a wave between its samples).
    std::array<double, kPoints> own{};
    double all = 0.0;
    constexpr int kDirections = 16;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double k = 1.0 + (static_cast<double>(i) + 0.5) / static_cast<double>(kPoints);
      double variance = 0.0;
      for (int direction = 0; direction < kDirections; ++direction) {
        const double angle = 0.5 * std::numbers::pi * (direction + 0.5) / kDirections;
        const double x = k * cycles * std::cos(angle);
        const double z = k * cycles * std::sin(angle);
        own[i] += std::pow(sinc(x) * sinc(z), 4.0) / kDirections;
        variance += (2.0 + std::cos(2.0 * std::numbers::pi * x)) * (2.0 + std::cos(2.0 * std::numbers::pi * z)) / 9.0 /
                    kDirections;
      }
      all += 2.0 * std::numbers::pi * std::pow(k, -5.0 / 3.0) * variance / static_cast<double>(kPoints);
    }
    Cut result{};
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double along = 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(kPoints);
      const double from = std::sqrt(std::max(0.0, 1.0 - along * along));
      const double to = std::sqrt(4.0 - along * along);
      constexpr int kSteps = 100;
      for (int step = 0; step < kSteps; ++step) {
        const double k = std::hypot(along, from + (to - from) * (step + 0.5) / kSteps);
        const auto place = std::min(static_cast<std::size_t>((k - 1.0) * static_cast<double>(kPoints)), kPoints - 1);
        result[i] += 4.0 * std::pow(k, -8.0 / 3.0) * own[place] / all * (to - from) / kSteps;
      }
    }
    return result;
  }

  const wind::turbulence::GustNoise& noise_;
  std::array<Cut, 2 * wind::turbulence::GustNoise::kTileOctaves> cuts_{};
};

/// How fast the gusts are carried, from how far they have come.
class Carriage {
 public:
  explicit Carriage(const wind::turbulence::GustNoise& noise)
      : period_m_(2.0 * std::numbers::pi / noise.octaves()[0].from_rad_m) {}
  double speed_m_s(const wind::turbulence::GustNoise::Carried& carried, double dt_s) {
    const std::uint32_t phase = carried.way_first.phase();
    const double way_m = static_cast<double>(phase - before_) / 4294967296.0 * period_m_;
    before_ = phase;
    return way_m / dt_s;
  }

 private:
  double period_m_;
  std::uint32_t before_ = 0;
};

/// The winds of one run, tick by tick.
struct Run {
  std::vector<wind::Vector> signal, synthetic;
  std::array<std::vector<wind::Vector>, kBlades.size()> blades;
};

/// What one seed gives.
struct SeedResult {
  struct Place {
    WindMoments moments;
    std::vector<double> density;
  };
  Place signal, synthetic;
  std::array<Place, kBlades.size()> blades;
  Increments increments;
  std::vector<double> model_density;
  // Over the segments and components, in each bin: of the wind with the sensor, and of each with itself.
  std::vector<std::complex<double>> cross;
  std::vector<double> wind_power, sensor_power;
};

/// `apart`: from a sample to the one that it is compared with; `step`: from one of those pairs to the next.
Increments increments_of(std::span<const wind::Vector> samples, std::size_t apart, std::size_t step) {
  double second = 0.0;
  double fourth = 0.0;
  std::vector<double> differences;
  for (std::size_t i = apart; i < samples.size(); i += step) {
    const wind::Vector difference = samples[i] - samples[i - apart];
    for (const double value : {difference.u_m_s, difference.v_m_s}) {
      differences.push_back(value);
      second += value * value;
      fourth += value * value * value * value;
    }
  }
  const auto count = static_cast<double>(differences.size());
  const double far_m_s = 4.0 * std::sqrt(second / count);
  const auto far = std::ranges::count_if(differences, [&](double value) { return std::abs(value) > far_m_s; });
  return {.kurtosis = fourth * count / (second * second), .far_part = static_cast<double>(far) / count};
}

/// A density without what was folded into it when it was sampled `rate_hz` times a second without a filter: what is at
/// f then has S(rate - f) besides, (rate / f - 1)^(-5/3) of it where the spectrum falls as f^(-5/3). What is folded in
/// from beyond the rate is left: most of that the sonic's own path of 0.1 m averages out. 2.7 dB at 4.8 of 10 Hz.
std::vector<double> unfolded(std::vector<double> density, double step_hz, double rate_hz) {
  for (std::size_t k = 1; k < density.size(); ++k) {
    density[k] /= 1.0 + std::pow(rate_hz / (static_cast<double>(k) * step_hz) - 1.0, -5.0 / 3.0);
  }
  return density;
}

class Comparer {
 public:
  Comparer(const SonicRecord& record, double interval_s, double gustiness,
           std::shared_ptr<const wind::turbulence::GustNoise> noise)
      : readings_(block_means(record, interval_s)),
        gustiness_(gustiness),
        ticks_a_sample_(static_cast<std::size_t>(std::lround(kTick_hz / record.rate_hz))),
        first_tick_(static_cast<std::size_t>(std::ceil(std::max(30.0, 3.0 * interval_s) * kTick_hz))),
        last_tick_(static_cast<std::size_t>(seconds(readings_.back().time.mono.time_since_epoch()) * kTick_hz)),
        noise_(std::move(noise)),
        cuts_(*noise_) {}

  double from_s() const { return static_cast<double>(first_tick_) / kTick_hz; }
  double to_s() const { return static_cast<double>(last_tick_) / kTick_hz; }

  /// The readings, held: what is heard of the sensor at each tick that is compared.
  std::vector<wind::Vector> held() const {
    std::vector<wind::Vector> result;
    std::size_t next = 0;
    wind::Vector last{};
    for (std::size_t tick = 0; tick <= last_tick_; ++tick) {
      for (; next < readings_.size() && readings_[next].time.mono <= time_of(tick); ++next) {
        last = wind::wind_from(readings_[next].speed_m_s, *readings_[next].direction_deg);
      }
      if (tick >= first_tick_) result.push_back(last);
    }
    return result;
  }

  SeedResult run(std::uint64_t seed, Welch& welch, const Welch::Segments& sensor) const {
    SeedResult result;
    result.model_density.resize(sensor.front().size());
    const Run run = simulate(seed, welch, result.model_density);
    const auto measure = [&welch](const std::vector<wind::Vector>& winds) {
      return SeedResult::Place{moments_of(winds), Welch::density(welch.segments(winds))};
    };
    const Welch::Segments wind = welch.segments(run.signal);
    result.signal = {moments_of(run.signal), Welch::density(wind)};
    result.synthetic = measure(run.synthetic);
    for (std::size_t i = 0; i < kBlades.size(); ++i) result.blades[i] = measure(run.blades[i]);
    const auto apart = static_cast<std::size_t>(std::lround(kIncrement_s * kTick_hz));
    result.increments = increments_of(run.signal, apart, ticks_a_sample_);

    const std::size_t bins = sensor.front().size();
    result.cross.resize(bins);
    result.wind_power.resize(bins);
    result.sensor_power.resize(bins);
    for (std::size_t segment = 0; segment < wind.size(); ++segment) {
      for (std::size_t k = 0; k < bins; ++k) {
        result.cross[k] += wind[segment][k] * std::conj(sensor[segment][k]);
        result.wind_power[k] += std::norm(wind[segment][k]);
        result.sensor_power[k] += std::norm(sensor[segment][k]);
      }
    }
    return result;
  }

 private:
  static MonoTime time_of(std::size_t tick) { return MonoTime(from_seconds(static_cast<double>(tick) / kTick_hz)); }

  Run simulate(std::uint64_t seed, const Welch& welch, std::vector<double>& model_density) const {
    wind::blend::BlendedEstimator estimator(1, {.climate = {.seed = seed}, .gustiness = gustiness_}, noise_);
    wind::ground::WindTapes tapes;
    const std::vector<double> weights = welch.weights(last_tick_ - first_tick_ + 1);
    double moments = 0.0;
    Carriage carriage(*noise_);
    Run run;
    std::size_t next = 0;
    for (std::size_t tick = 0; tick <= last_tick_; ++tick) {
      for (; next < readings_.size() && readings_[next].time.mono <= time_of(tick); ++next) {
        estimator.accept(0, readings_[next]);
      }
      const wind::Vector wind = estimator.advance(time_of(tick)).wind;
      const wind::ground::Wind ground = written_to(tapes, {{}, estimator.ground(), estimator.stroke()});
      const double speed_m_s = carriage.speed_m_s(ground.gusts.carried, 1.0 / kTick_hz);
      if (tick < first_tick_) continue;
      run.signal.push_back(wind);
      const wind::turbulence::GustNoise::Moment left = estimator.gusts_at(0);
      run.synthetic.push_back(noise_->everywhere(left) + noise_->local(left, 0.0, 0.0));
      for (std::size_t i = 0; i < kBlades.size(); ++i) {
        run.blades[i].push_back(ground.at(*noise_, kBlades[i].east_m, kBlades[i].south_m));
      }
      if (tick % 60 != 0) continue;
      cuts_.add(left, speed_m_s, welch.step_hz(), model_density, weights[tick - first_tick_]);
      moments += 1.0;
    }
    for (double& value : model_density) value /= moments;
    return run;
  }

  std::vector<wind::Reading> readings_;
  double gustiness_;
  std::size_t ticks_a_sample_;  ///< of the record
  std::size_t first_tick_, last_tick_;
  std::shared_ptr<const wind::turbulence::GustNoise> noise_;
  TileCuts cuts_;
};

/// The seeds' results, from as many threads as the machine has; each seed's in its own place, so that the sums are the
/// same however many there are.
std::vector<SeedResult> run_seeds(const Comparer& comparer, int seeds, const Welch::Segments& sensor) {
  std::vector<SeedResult> results(static_cast<std::size_t>(seeds));
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    Welch welch(kTick_hz, kSegment_s, kTopHz);
    for (std::size_t i = next++; i < results.size(); i = next++) results[i] = comparer.run(i + 1, welch, sensor);
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) threads.emplace_back(work);
  work();
  threads.clear();
  return results;
}

void add_to(std::vector<double>& sum, const std::vector<double>& values, double part) {
  sum.resize(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) sum[k] += part * values[k];
}

std::vector<double> decibels(const std::vector<double>& density, const std::vector<double>& reference, double step_hz,
                             const std::vector<Band>& bands) {
  std::vector<double> result;
  result.reserve(bands.size());
  for (const Band& band : bands) {
    result.push_back(decibel(power_in(density, step_hz, band) / power_in(reference, step_hz, band)));
  }
  return result;
}

}  // namespace

BlendComparison compare_blend(const SonicRecord& record, double interval_s, double gustiness, int seeds,
                              const std::shared_ptr<const wind::turbulence::GustNoise>& noise) {
  const Comparer comparer(record, interval_s, gustiness, noise);
  Welch welch(kTick_hz, kSegment_s, kTopHz);
  BlendComparison result;
  result.interval_s = interval_s;
  result.gustiness = gustiness;
  result.seeds = seeds;
  result.from_s = comparer.from_s();
  result.to_s = comparer.to_s();
  result.step_hz = welch.step_hz();

  // The record itself, over the same time, and what was heard of it.
  const auto index = [&record](double time_s) {
    return static_cast<std::size_t>(std::lround(time_s * record.rate_hz));
  };
  const std::span<const wind::Vector> compared =
      std::span(record.samples).subspan(index(result.from_s), index(result.to_s) - index(result.from_s));
  result.record = moments_of(compared);
  result.record_density = Welch::density(Welch(record.rate_hz, kSegment_s, kTopHz).segments(compared));
  result.record_increments =
      increments_of(compared, static_cast<std::size_t>(std::lround(kIncrement_s * record.rate_hz)), 1);
  const Welch::Segments sensor = welch.segments(comparer.held());
  result.sensor_density = Welch::density(sensor);
  result.octaves = octaves_down(kToHz, kFromHz);
  double from_hz = kToHz;
  while (from_hz < kTopHz / 2.0) {
    result.above.push_back({from_hz, 2.0 * from_hz});
    from_hz *= 2.0;
  }

  // The mean of the seeds.
  const std::vector<SeedResult> all = run_seeds(comparer, seeds, sensor);
  const double part = 1.0 / seeds;
  const auto add = [&](PlaceComparison& place, const SeedResult::Place& seed) {
    place.variance += part * seed.moments.variance_m2_s2 / result.record.variance_m2_s2;
    place.mean_speed += part * seed.moments.mean_speed_m_s / result.record.mean_speed_m_s;
    add_to(place.density, seed.density, part);
  };
  std::vector<std::complex<double>> cross(result.sensor_density.size());
  std::vector<double> wind_power;
  std::vector<double> sensor_power;
  for (const SeedResult& seed : all) {
    add(result.signal, seed.signal);
    result.increments.kurtosis += part * seed.increments.kurtosis;
    result.increments.far_part += part * seed.increments.far_part;
    for (std::size_t i = 0; i < kBlades.size(); ++i) add(result.blades[i], seed.blades[i]);
    add_to(result.synthetic_density, seed.synthetic.density, part);
    add_to(result.model_density, seed.model_density, part);
    for (std::size_t k = 0; k < cross.size(); ++k) cross[k] += part * seed.cross[k];
    add_to(wind_power, seed.wind_power, part);
    add_to(sensor_power, seed.sensor_power, part);
  }

  // Band by band.
  const auto against_record = [&](PlaceComparison& place) {
    place.octaves = decibels(place.density, result.record_density, result.step_hz, result.octaves);
    place.above = decibels(place.density, result.record_density, result.step_hz, result.above);
  };
  against_record(result.signal);
  const std::vector<double> record_unfolded = unfolded(result.record_density, result.step_hz, record.rate_hz);
  result.unfolded_above = decibels(result.signal.density, record_unfolded, result.step_hz, result.above);
  for (PlaceComparison& blade : result.blades) against_record(blade);
  result.sensor_octaves = decibels(result.sensor_density, result.record_density, result.step_hz, result.octaves);
  result.synthetic_above = decibels(result.synthetic_density, result.model_density, result.step_hz, result.above);
  for (const Band& band : result.above)
    result.model_above.push_back(power_in(result.model_density, result.step_hz, band));

  // How alike wind and readings are, wave by wave.
  result.coherent_to_hz = kCrossover / interval_s / 3.0;
  result.least_coherence = 1.0;
  int bins = 0;
  for (std::size_t k = 1; static_cast<double>(k) * result.step_hz <= result.coherent_to_hz; ++k) {
    if (static_cast<double>(k) * result.step_hz < kFromHz) continue;
    const double coherence = std::sqrt(std::norm(cross[k]) / (wind_power[k] * sensor_power[k]));
    result.coherence += coherence;
    result.least_coherence = std::min(result.least_coherence, coherence);
    ++bins;
  }
  result.coherence /= bins;
  return result;
}

}  // namespace yuragi::proof
