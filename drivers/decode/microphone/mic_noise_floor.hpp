#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace yuragi::drivers::decode::microphone {

/// The level of a calm, as a low percentile of all levels of the recent past: the running minimum of a noise estimator
/// (Martin 2001, "Noise power spectral density estimation based on optimal smoothing and minimum statistics"), made of
/// a histogram that forgets, so that it costs the same for an hour and for a week.
///
/// A wind that never dies down raises it: in an hour of wind of 10 % turbulence, the quietest moments have half the
/// power of the rest, and taking that off would cost a fifth of the speed. So there is no estimate in the first hour,
/// and the memory should span a night. Thread-safe: no. Realtime-safe: yes.
class MicNoiseFloor {
 public:
  /// `memory_s`: how long until a level is forgotten to a third.
  explicit MicNoiseFloor(double memory_s) noexcept : memory_s_(memory_s) {}

  /// Level in dB re full scale, held for `duration_s`.
  void add(double level_db, double duration_s) noexcept;

  /// Returns the floor in dB; nullopt until an hour has been recorded, or half the memory if that is less.
  std::optional<double> floor_db() const noexcept;

 private:
  static constexpr double kLowest_db = -140.0;
  static constexpr double kBin_db = 0.25;
  static constexpr std::size_t kBins = 640;

  double memory_s_;
  double measured_s_ = 0.0;
  double total_s_ = 0.0;  ///< what is remembered
  std::array<double, kBins> weight_s_{};
};

}  // namespace yuragi::drivers::decode::microphone
