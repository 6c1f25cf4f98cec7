#pragma once

#include <optional>

namespace yuragi {

/// Looks for automatic gain in the device, which makes a microphone useless as an anemometer and cannot be seen in one
/// level alone. Two signs, over some minutes:
///  - when the wind's band grows louder, the band above it grows softer: the gain went down. Wind and sound raise both,
///    or one of them.
///  - the wind's band is loud and hardly varies: no wind does that. (A machine beside the microphone does: the same
///    advice.)
/// Thread-safe: no. Realtime-safe: yes.
class MicGainWatch {
 public:
  /// Levels in dB re full scale, before any weighting, held for `duration_s`; `high_db` where there is such a band.
  void add(double level_db, std::optional<double> high_db, double duration_s) noexcept;

  bool suspects() const noexcept { return suspects_; }

 private:
  double heard_s_ = 0.0;
  double level_mean_ = 0.0, level_variance_ = 0.0;
  double high_mean_ = 0.0, high_variance_ = 0.0;
  double covariance_ = 0.0;
  bool suspects_ = false;
};

}  // namespace yuragi
