#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace yuragi::drivers::decode::microphone {

/// Means, variances and the covariance of two values that come together, with a memory; plain ones until that is full
/// (West 1979, "Updating mean and variance estimates: an improved method").
struct RunningPair {
  double mean_a = 0.0, mean_b = 0.0;
  double variance_a = 0.0, variance_b = 0.0;
  double covariance = 0.0;
  double measured_s = 0.0;

  /// Adds values that held for `duration_s`; values older than `memory_s` fade.
  void add(double a, double b, double duration_s, double memory_s) noexcept;
  /// -1 to 1; 0 if one of them does not move.
  double correlation() const noexcept;
};

/// Detects automatic gain in the device, which makes a microphone useless as an anemometer and cannot be seen in one
/// level alone. Three signs, over some minutes:
///  - when the wind's band grows louder, the band above it grows softer: the gain went down at once. Wind and sound
///    raise both, or one of them.
///  - after the wind's band was loud, the band above is softer than before: the gain went down late. Without a gain
///    that follows, before and after look the same.
///  - the wind's band is loud and hardly varies: no wind does that. (A machine beside the microphone does: the same
///    advice.)
/// Continuous speech can hide the second. Thread-safe: no. Realtime-safe: yes.
class MicGainWatch {
 public:
  /// Levels in dB re full scale, before any weighting, held for `duration_s`, a quarter of a second or so; `high_db`
  /// where there is such a band.
  void add(double level_db, std::optional<double> high_db, double duration_s) noexcept;

  bool suspects() const noexcept { return suspects_; }

 private:
  static constexpr std::size_t kBefore = 4;  ///< blocks: a second to either side

  struct Levels {
    double level_db = 0.0, high_db = 0.0;
  };
  RunningPair now_;    ///< the wind's band, and the one above it
  RunningPair after_;  ///< the wind's band, and how the one above it changed from before to after
  std::array<Levels, 2 * kBefore + 1> recent_{};
  std::size_t count_ = 0;
  bool suspects_ = false;
};

}  // namespace yuragi::drivers::decode::microphone
