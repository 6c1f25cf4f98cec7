#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace yuragi::wind::turbulence {

/// How much more power gusts have at a site than slow readings let expect, octave by octave of frequency.
///
/// A sensor with a reading every 14 s does not resolve faster gusts: they are made by von Karman's spectrum, fitted to
/// its readings, and that spectrum is not every site's (trees, houses and slopes stir the air at scales of their own).
/// The error of the fit is much alike from day to day, at the same frequency rather than at the same wavelength; so it
/// is learnt while a fast source is live, as a mean of decibels, and forgotten over days (engine/wind/model.md W30).
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

  /// The prior, in the octaves from the first on; it weighs as much as a quarter of a day of learning. More octaves
  /// than there are, and what is not finite, are left out.
  void expect(std::span<const double> octaves_db) noexcept;

  /// So it was in an octave for dt_s.
  void learn(std::size_t octave, double excess_db, double dt_s) noexcept;

  /// The correction, within kMost_db: grows from 0 in the first minutes of learning. An octave above all of which
  /// anything is known is as the one below.
  Decibels octaves_db() const noexcept;
  /// How long each has been learnt, at most the memory of three days.
  const Seconds& known_s() const noexcept { return known_s_; }
  /// The mean of what was learnt, 0 where nothing was.
  const Decibels& learnt_db() const noexcept { return learnt_db_; }
  /// Both, from a file; false, and nothing is changed, where they cannot be that.
  bool restore(std::span<const double> known_s, std::span<const double> learnt_db) noexcept;

  /// By how much the power at a frequency differs from a fit to the readings of a source of this interval (above
  /// 0): 1 up to the frequency that the source resolves, 0.37 over the interval, and for a source of kQuick_s or less.
  double power(double frequency_hz, double interval_s) const noexcept;

 private:
  Seconds known_s_{};
  Decibels learnt_db_{};
  Seconds expected_s_{};
  Decibels expected_db_{};
};

}  // namespace yuragi::wind::turbulence
