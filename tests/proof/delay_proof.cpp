// How long the wind outside takes to move the wall, octave by octave: derived from the filters on the way, and measured
// with waves through the estimator, the tape and a real grass scene.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <numeric>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"
#include "engine/wind/blend/blended_estimator.hpp"
#include "engine/wind/blend/source_estimator.hpp"
#include "engine/wind/ground/wind_tapes.hpp"
#include "tests/proof/estimated_wind.hpp"

namespace yuragi::proof {
namespace {

using Complex = std::complex<double>;

constexpr double kDelayTick_s = 1.0 / 60.0;
constexpr double kMeanSpeed_m_s = 8.0;
constexpr double kWave_m_s = 0.01;
/// Measured and derived delays agree within a quarter of a tick and this part of them.
constexpr double kTolerance = 0.02;
/// Grass as it comes, but for what is not the measured wind (waves of the canopy) and for lengths that differ, and with
/// them the rates of their oscillators.
constexpr double kNatural_hz = 2.0;
constexpr double kDampingRatio = 0.2;
constexpr double kHybrid = 1.0;

/// A place downwind of the windward edge, where a sensor is taken to stand of which nobody said where it does.
struct DelayPlace {
  const char* name;
  double way_m;
};
/// Of meadows of 7 and 60 m, the wind blowing along a diagonal: half of it, and all.
constexpr std::array<DelayPlace, 4> kDelayPlaces = {{{"middle, 7 m", 3.5 * std::numbers::sqrt2},
                                                     {"far corner, 7 m", 7.0 * std::numbers::sqrt2},
                                                     {"middle, 60 m", 30.0 * std::numbers::sqrt2},
                                                     {"far corner, 60 m", 60.0 * std::numbers::sqrt2}}};
constexpr double kDelayReach_m = 30.0 * std::numbers::sqrt2;
/// Beyond the way over the wind's speed, what is left of a wave lags by a part of it between these: what is lost is
/// lost by the bands' causal low passes, and all waves are read sooner by what they lag together. Slow waves lag most,
/// and quick ones are a little early.
constexpr double kMinLag = -0.03;
constexpr double kMaxLag = 0.25;
/// Where less is left of a wave than this part, it is noise that moves the place.
constexpr double kMinKept = 0.5;

double turn_rad_s(double frequency_hz) {
  return 2.0 * std::numbers::pi * frequency_hz;
}

// What each part of the way passes of a wave exp(i w t).

Complex ahead_by(double time_s, double frequency_hz) {
  return std::polar(1.0, turn_rad_s(frequency_hz) * time_s);
}

/// A block mean over the interval, heard at its end.
Complex averaged(double frequency_hz, double interval_s) {
  const Complex turn(0.0, turn_rad_s(frequency_hz) * interval_s);
  return (1.0 - std::exp(-turn)) / turn;
}

/// How far each band is trusted, after the mean.
wind::blend::BandWeights trusted(double interval_s) {
  wind::blend::BandWeights weights{1.0};
  for (std::size_t band = 0; band < wind::turbulence::OctaveFollower::kBands; ++band) {
    weights[1 + band] =
        1.0 / (1.0 + std::pow(wind::turbulence::OctaveFollower::centre_hz(band) * interval_s / 0.5, 4.0));
  }
  return weights;
}

/// From the reading to the wind: it is held for an interval, and what the bands pass of that, each as far as it is
/// trusted, adds up. A tick takes what is there at its end, as if it had been there from its begin on.
Complex estimated(double frequency_hz, double interval_s) {
  return averaged(frequency_hz, interval_s) *
         wind::turbulence::OctaveFollower::Response(frequency_hz).weighted(trusted(interval_s)) *
         ahead_by(kDelayTick_s, frequency_hz);
}

/// What comes a way downwind along the tape, the time that it takes taken out: each band less what it loses.
Complex carried(double frequency_hz, double interval_s, double way_m, const wind::ground::GustCoherence& coherence) {
  wind::blend::BandWeights weights = trusted(interval_s);
  for (std::size_t band = 0; band < wind::turbulence::OctaveFollower::kBands; ++band) {
    const double centre_hz = wind::turbulence::OctaveFollower::centre_hz(band);
    const double on_tape =
        std::clamp(std::log2(coherence.speed_m_s / (4.0 * wind::ground::WindTape::kStep_m * centre_hz)), 0.0, 1.0);
    weights[1 + band] *= on_tape * std::exp(-coherence.distance_m(way_m, 0.0) * coherence.loss_per_m(centre_hz));
  }
  return wind::turbulence::OctaveFollower::Response(frequency_hz).weighted(weights);
}

/// From the wind to a blade's bend: scenes::Wind, and the part of it that is an oscillator. Both are stepped exactly,
/// with the wind at the end of the tick: half a tick ahead of it.
Complex bent(double frequency_hz, double /*interval_s*/) {
  const Complex scene = 1.0 / std::pow(Complex(1.0, turn_rad_s(frequency_hz) / scenes::Wind::kOmega_rad_s), 2.0);
  const double ratio = frequency_hz / kNatural_hz;
  const Complex oscillator = 1.0 / Complex(1.0 - ratio * ratio, 2.0 * kDampingRatio * ratio);
  const Complex early = ahead_by(0.5 * kDelayTick_s, frequency_hz);
  return scene * early * ((1.0 - kHybrid) + kHybrid * oscillator * early);
}

/// Two waves near each other: what lies between their phases is the delay of a gust made of them.
struct Pair {
  double low_hz = 0.0, high_hz = 0.0;
  double centre_hz() const { return 0.5 * (low_hz + high_hz); }
};

double group_delay_s(Complex at_low, Complex at_high, const Pair& pair) {
  return -std::arg(at_high / at_low) / turn_rad_s(pair.high_hz - pair.low_hz);
}

double derived_s(Complex (*pass)(double, double), const Pair& pair, double interval_s) {
  return group_delay_s(pass(pair.low_hz, interval_s), pass(pair.high_hz, interval_s), pair);
}

/// What a signal has of a wave, from the sums over whole numbers of its periods.
struct Tone {
  double frequency_hz = 0.0;
  Complex wind{}, pose{};
  std::array<Complex, kDelayPlaces.size()> places{};

  void add(double time_s, double wind_m_s, double pose_rad, const std::array<double, kDelayPlaces.size()>& places_m_s) {
    const Complex turn = std::polar(1.0, -turn_rad_s(frequency_hz) * time_s);
    wind += wind_m_s * turn;
    pose += pose_rad * turn;
    for (std::size_t i = 0; i < places.size(); ++i) places[i] += places_m_s[i] * turn;
  }
};

/// A wind from south of constant mean with waves, and what becomes of it.
class Passage {
 public:
  Passage(double interval_s, double lowest_hz, double highest_hz)
      : interval_s_(interval_s), window_s_(interval_s * std::ceil(20.0 / lowest_hz / interval_s)) {
    // About 5 % to both sides of each octave's middle. Odd numbers of periods in the window, of which no sum,
    // difference or double is odd: what bending makes of two waves falls beside all others.
    const auto octaves = std::lround(std::log2(highest_hz / lowest_hz));
    for (long octave = 0; octave <= octaves; ++octave) {
      const double centre_hz = lowest_hz * std::exp2(static_cast<double>(octave));
      const double cycles = 2.0 * std::round(0.5 * centre_hz * window_s_);
      const double aside = 2.0 * std::round(0.025 * cycles) + 1.0;
      pairs_.push_back({(cycles - aside) / window_s_, (cycles + aside) / window_s_});
      tones_.push_back({.frequency_hz = pairs_.back().low_hz});
      tones_.push_back({.frequency_hz = pairs_.back().high_hz});
    }
  }

  void run() {
    wind::blend::BlendedEstimator estimator(1, {.climate = {}, .reach_m = kDelayReach_m}, shared_noise());
    wind::ground::WindTapes tapes;
    const std::unique_ptr<scenes::Scene> grass = make_grass();
    const auto settle = static_cast<int>(std::lround(kSettle_s / kDelayTick_s));
    const auto last = settle + static_cast<int>(std::lround(window_s_ / kDelayTick_s));
    int told = 0;
    for (int tick = 0; tick < last; ++tick) {
      const double time_s = tick * kDelayTick_s;
      for (; told * interval_s_ <= time_s + 1e-9; ++told) {
        wind::Reading reading;
        reading.time.mono = MonoTime(from_seconds(told * interval_s_));
        reading.speed_m_s = block_mean_m_s(told * interval_s_);
        reading.direction_deg = 180.0;
        estimator.accept(0, reading);
      }
      estimator.advance(MonoTime(from_seconds(time_s)));
      // What is known of the wind goes to the scene; the noise, which is known too, is left out.
      const wind::Vector known = estimator.ground().everywhere - shared_noise()->everywhere(estimator.ground().gusts);
      grass->tick(known, kDelayTick_s);
      tapes.write(estimator.stroke());
      if (tick < settle) continue;
      std::array<double, kDelayPlaces.size()> places_m_s{};
      for (std::size_t i = 0; i < kDelayPlaces.size(); ++i) {
        const wind::ground::WindTapes::Reading reading = tapes.at(0.0, kDelayReach_m - kDelayPlaces[i].way_m);
        places_m_s[i] = (reading.mean + reading.gusts).v_m_s;
      }
      const double bend_rad = mean_bend_rad(*grass);
      for (Tone& tone : tones_) tone.add(time_s, known.v_m_s, bend_rad, places_m_s);
    }
    coherence_ = estimator.stroke().coherence;
    octave_hz_ = estimator.stroke().octave_hz;
  }

  double interval_s() const { return interval_s_; }
  const std::vector<Pair>& pairs() const { return pairs_; }
  double wind_delay_s(std::size_t pair) const {
    return group_delay_s(tones_[2 * pair].wind, tones_[2 * pair + 1].wind, pairs_[pair]);
  }
  double pose_delay_s(std::size_t pair) const {
    return group_delay_s(tones_[2 * pair].pose, tones_[2 * pair + 1].pose, pairs_[pair]);
  }
  /// By how much a place is later than the wind at the edge beyond the time that the wind takes for the way.
  double lag_s(std::size_t pair, std::size_t place) const {
    const auto since_edge = [&](const Tone& tone) {
      return tone.places[place] / tone.wind * ahead_by(crossing_s(place), tone.frequency_hz);
    };
    return group_delay_s(since_edge(tones_[2 * pair]), since_edge(tones_[2 * pair + 1]), pairs_[pair]);
  }
  double derived_lag_s(std::size_t pair, std::size_t place) const {
    const auto since_edge = [&](double frequency_hz) {
      return carried(frequency_hz, interval_s_, kDelayPlaces.at(place).way_m, coherence_) /
             wind::turbulence::OctaveFollower::Response(frequency_hz).weighted(trusted(interval_s_));
    };
    return group_delay_s(since_edge(pairs_[pair].low_hz), since_edge(pairs_[pair].high_hz), pairs_[pair]) -
           read_sooner_s(place);
  }
  /// By how much sooner the tape is read at a place: the time by which what comes there, of gusts of von Karman's
  /// spectrum, is most like what was measured.
  double read_sooner_s(std::size_t place) const {
    constexpr double kStep_s = 0.001;
    const double way_m = kDelayPlaces.at(place).way_m;
    double best_s = 0.0;
    double most = 0.0;
    for (int step = 0; step * kStep_s < 0.5 * crossing_s(place); ++step) {
      double alike = 0.0;
      for (std::size_t i = 0; i < wind::ground::kTileOctaveCount; ++i) {
        const auto frequency_hz = static_cast<double>(octave_hz_[i]);
        const double length = frequency_hz * coherence_.length_m / coherence_.speed_m_s;
        const Complex left = carried(frequency_hz, interval_s_, way_m, coherence_) *
                             std::conj(carried(frequency_hz, interval_s_, 0.0, coherence_));
        alike += length / std::pow(1.0 + 70.8 * length * length, 5.0 / 6.0) *
                 std::real(left * ahead_by(step * kStep_s, frequency_hz));
      }
      if (alike <= most) continue;
      most = alike;
      best_s = step * kStep_s;
    }
    return best_s;
  }
  /// The part of a wave that is left at a place.
  double kept(std::size_t pair, std::size_t place) const {
    return std::abs(tones_[2 * pair].places[place] / tones_[2 * pair].wind);
  }
  double crossing_s(std::size_t place) const { return kDelayPlaces.at(place).way_m / coherence_.speed_m_s; }

 private:
  static constexpr double kSettle_s = 600.0;

  /// The waves are cosines.
  double block_mean_m_s(double end_s) const {
    double speed_m_s = kMeanSpeed_m_s;
    for (const Tone& tone : tones_) {
      const Complex wave = std::polar(kWave_m_s, turn_rad_s(tone.frequency_hz) * end_s);
      speed_m_s += std::real(wave * averaged(tone.frequency_hz, interval_s_));
    }
    return speed_m_s;
  }

  static std::unique_ptr<scenes::Scene> make_grass() {
    const auto is_grass = [](const scenes::Description* kind) { return kind->name == std::string_view("grass"); };
    const scenes::Description& kind = **std::ranges::find_if(scenes::scene_table(), is_grass);
    const ParameterValues::Map small = {{"blades_across", std::int64_t{8}},
                                        {"blades_deep", std::int64_t{8}},
                                        {"blade_length_variation", 0.0},
                                        {"canopy_waves", 0.0}};
    return kind.make(ParameterValues::resolve(kind.parameters, small).value(), {.gusts = shared_noise()});
  }

  /// Toward north, where the wind goes.
  static double mean_bend_rad(const scenes::Scene& scene) {
    const std::vector<float>& south_rad = std::get<pose::StrandPose>(scene.pose()).bend_south_rad;
    return -std::accumulate(south_rad.begin(), south_rad.end(), 0.0) / static_cast<double>(south_rad.size());
  }

  double interval_s_, window_s_;
  std::vector<Pair> pairs_;
  std::vector<Tone> tones_;
  wind::ground::GustCoherence coherence_;  // at the end
  wind::ground::OctaveLanes octave_hz_{};
};

/// Over the ground: way over speed, and a little for what is lost.
void expect_on_time_at_places(const Passage& passage) {
  fmt::print("| octave about, Hz | place | way / U, s | lag besides, s: derived | measured | wave that is left |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  for (std::size_t i = 0; i < passage.pairs().size(); ++i) {
    for (std::size_t place = 0; place < kDelayPlaces.size(); ++place) {
      if (passage.kept(i, place) < kMinKept) continue;
      const double crossing_s = passage.crossing_s(place);
      const double derived_s = passage.derived_lag_s(i, place);
      const double measured_s = passage.lag_s(i, place);
      const double centre_hz = passage.pairs()[i].centre_hz();
      fmt::print("| {:.4g} | {} | {:.2f} | {:.3f} | {:.3f} | {:.2f} |\n", centre_hz, kDelayPlaces.at(place).name,
                 crossing_s, derived_s, measured_s, passage.kept(i, place));
      EXPECT_NEAR(measured_s, derived_s, kDelayTick_s) << kDelayPlaces.at(place).name << ", " << centre_hz << " Hz";
      EXPECT_GE(measured_s, kMinLag * crossing_s - kDelayTick_s)
          << kDelayPlaces.at(place).name << ", " << centre_hz << " Hz";
      EXPECT_LE(measured_s, kMaxLag * crossing_s + kDelayTick_s)
          << kDelayPlaces.at(place).name << ", " << centre_hz << " Hz";
    }
  }
}

void expect_as_derived(Passage& passage) {
  passage.run();
  const double interval_s = passage.interval_s();
  fmt::print(
      "| sensor of {:g} s: octave about, Hz | wind to reading, s | reading to wind, s: derived | measured | wind "
      "to pose: derived | measured | all, measured |\n| --- | --- | --- | --- | --- | --- | --- |\n",
      interval_s);
  for (std::size_t i = 0; i < passage.pairs().size(); ++i) {
    const Pair& pair = passage.pairs()[i];
    // The wave is cosine in the wind outside: what is measured of it counts from there.
    const double reading_s = derived_s(averaged, pair, interval_s);
    const double blend_s = derived_s(estimated, pair, interval_s);
    EXPECT_NEAR(wind::blend::blend_group_delay_s(pair.centre_hz(), interval_s, interval_s),
                reading_s + blend_s + kDelayTick_s, kTolerance * blend_s)
        << "what the estimator says of itself, at " << pair.centre_hz() << " Hz";
    const double bent_s = derived_s(bent, pair, interval_s);
    const double blend_measured_s = passage.wind_delay_s(i) - reading_s;
    const double bent_measured_s = passage.pose_delay_s(i) - passage.wind_delay_s(i);
    fmt::print("| {:.4g} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", pair.centre_hz(), reading_s,
               blend_s, blend_measured_s, bent_s, bent_measured_s, passage.pose_delay_s(i));
    EXPECT_NEAR(blend_measured_s, blend_s, 0.25 * kDelayTick_s + kTolerance * blend_s) << pair.centre_hz() << " Hz";
    EXPECT_NEAR(bent_measured_s, bent_s, 0.25 * kDelayTick_s + kTolerance * bent_s) << pair.centre_hz() << " Hz";
  }
  expect_on_time_at_places(passage);
}

TEST(DelayOfTheWind, IsAsDerivedForASensorOf100Milliseconds) {
  Passage passage(0.1, 0.0125, 1.6);
  expect_as_derived(passage);
}

TEST(DelayOfTheWind, IsAsDerivedForASensorOfASecond) {
  Passage passage(1.0, 0.00625, 0.4);
  expect_as_derived(passage);
}

TEST(DelayOfTheWind, IsAsDerivedForASensorOf14Seconds) {
  Passage passage(14.0, 0.00375, 0.03);
  expect_as_derived(passage);
}

}  // namespace
}  // namespace yuragi::proof
