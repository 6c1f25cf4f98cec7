#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/base/state_pass.hpp"

namespace yuragi::wind::turbulence {

/// The power of gusts at a site relative to the expectation from slow readings, octave by octave of frequency.
///
/// A sensor with a reading every 14 s does not resolve faster gusts: they are made from von Karman's spectrum, fitted
/// to its readings, which does not fit every site (trees, houses and slopes stir the air at their own scales). The
/// error of the fit is similar from day to day, at the same frequency rather than at the same wavelength; so it is
/// learnt while a fast source is live, as a mean of decibels, and forgotten over days (engine/wind/model.md W30).
/// Thread-safe: no. Realtime-safe: yes.
class SiteSpectrum {
 public:
  /// Octave i begins at kFrom_hz 2^i.
  static constexpr std::size_t kOctaves = 7;
  static constexpr double kFrom_hz = 0.0375;
  static double centre_hz(std::size_t octave) noexcept;
  /// A source with this interval or less can be learnt from, and needs no correction.
  static constexpr double kQuick_s = 1.0;
  /// No octave is corrected by more than this.
  static constexpr double kMost_db = 10.0;
  using Decibels = std::array<double, kOctaves>;
  using Seconds = std::array<double, kOctaves>;

  /// The prior, in the octaves from the first on; it has the weight of a quarter of a day of learning. Excess octaves,
  /// and values that are not finite, are ignored.
  void expect(std::span<const double> octaves_db) noexcept;

  /// So it was in an octave for dt_s.
  void learn(std::size_t octave, double excess_db, double dt_s) noexcept;

  /// The correction, within kMost_db: grows from 0 in the first minutes of learning. Octaves above all known ones have
  /// the value of the one below.
  Decibels octaves_db() const noexcept;
  /// How long each has been learnt, at most the memory of three days.
  const Seconds& known_s() const noexcept { return known_s_; }
  /// The mean of the learnt values, 0 if there are none.
  const Decibels& learnt_db() const noexcept { return learnt_db_; }
  /// Restores both from a file. Returns false, and changes nothing, if they are invalid.
  bool restore(std::span<const double> known_s, std::span<const double> learnt_db) noexcept;

  /// The power at a frequency relative to a fit to the readings of a source of this interval (above 0): 1 up to the
  /// frequency that the source resolves, 0.37 over the interval, and for a source of kQuick_s or less.
  double power(double frequency_hz, double interval_s) const noexcept;

  void list_state(StatePass& pass) {
    for (auto* octaves : {&known_s_, &expected_s_}) {
      pass.within(std::span<double>(*octaves), 0.0, StatePass::kLargestTotal);
    }
    pass(learnt_db_, expected_db_);
  }

 private:
  Seconds known_s_{};
  Decibels learnt_db_{};
  Seconds expected_s_{};
  Decibels expected_db_{};
};

}  // namespace yuragi::wind::turbulence
