#pragma once

#include <cstdint>

namespace yuragi::drivers::decode::microphone {

/// When a sample was at the microphone. A sound system reports that once a buffer, with the scheduler's jitter; the
/// converter's clock is steady, and this follows it: a second-order delay-locked loop (Adriaensen 2005, "Using a DLL to
/// filter time", Linux Audio Conference). Its band starts wide, to lock soon, and narrows.
/// Times are nanoseconds of any steady clock. Thread-safe: no. Realtime-safe: yes.
class SampleClock {
 public:
  /// `rate_hz`: the device's nominal rate; the true one is measured.
  explicit SampleClock(double rate_hz) noexcept : nominal_ns_(1e9 / rate_hz), sample_ns_(nominal_ns_) {}

  /// The buffer that ends before sample `end_sample` arrived at `time_ns`. Returns when that was, smoothed. After a gap
  /// (samples that go back, or a time that is off by more than half a second) it starts again.
  std::int64_t add(std::uint64_t end_sample, std::int64_t time_ns) noexcept;

  /// Duration of a sample as it has turned out, ns.
  double sample_ns() const noexcept { return sample_ns_; }

 private:
  double nominal_ns_;
  double sample_ns_;
  bool is_locked_ = false;
  std::uint64_t last_sample_ = 0;
  std::int64_t last_ns_ = 0;  ///< smoothed
  double fraction_ns_ = 0.0;  ///< remainder of the rounding of last_ns_
  double locked_s_ = 0.0;
};

}  // namespace yuragi::drivers::decode::microphone
