#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <string>

namespace yuragi::drivers::decode::microphone {

// The features of a quarter of a second of sound: sums of Welch periodograms (Welch 1967, "The use of fast Fourier
// transform for the estimation of power spectra"), small enough for a pipe, and all that the wind is computed from.
// Powers are mean squares, full scale = 1: a sine that just reaches full scale has 0.5.

inline constexpr std::size_t kMicMaxChannels = 4;
inline constexpr std::size_t kMicMaxBands = 12;
inline constexpr std::size_t kMicMaxPairs = kMicMaxChannels * (kMicMaxChannels - 1) / 2;

/// The index of the pair of channels `a` < `b` among all pairs: (0,1) (0,2) (1,2) (0,3) (1,3) (2,3).
constexpr std::size_t mic_pair(std::size_t a, std::size_t b) noexcept {
  return b * (b - 1) / 2 + a;
}

constexpr std::size_t mic_pair_count(std::size_t channels) noexcept {
  return channels * (channels - 1) / 2;
}

/// Constants of a stream.
struct MicHello {
  double rate_hz = 0.0;
  std::uint8_t channels = 1;
  std::uint8_t bands = 1;
  std::array<std::uint16_t, kMicMaxBands> bins{};  ///< frequencies of the transform in each band
  std::uint16_t high_bins = 0;  ///< the same for the band above the wind's; 0: the rate is too low for one
  std::string device;           ///< for people

  bool operator==(const MicHello&) const = default;
};

/// One channel of a block.
struct MicChannel {
  std::array<float, kMicMaxBands> power{};  ///< mean square in each band, mean over the segments
  float high_power = 0.0F;                  ///< of the band above the wind's; 0 if there is none
  float total_power = 0.0F;                 ///< of the samples, without their mean
  float clipped = 0.0F;                     ///< part of the samples at full scale, 0 to 1
  float peak = 0.0F;                        ///< largest magnitude without the mean; 0: digital silence

  bool operator==(const MicChannel&) const = default;
};

/// One hop of the stream.
struct MicBlock {
  std::uint64_t end_sample = 0;  ///< samples since the stream began
  std::int64_t end_mono_ns = 0;  ///< when the last of them was at the microphone, on the system's monotonic clock
  std::uint32_t lost_samples = 0;
  std::uint32_t invalid_samples = 0;  ///< not finite, or far above full scale; counted as 0
  std::uint16_t segments = 0;
  std::array<MicChannel, kMicMaxChannels> channels{};
  /// Of each pair a < b and each band, the mean of F_a conj(F_b), scaled as power is.
  std::array<std::array<std::complex<float>, kMicMaxBands>, kMicMaxPairs> cross{};

  bool operator==(const MicBlock&) const = default;
};

}  // namespace yuragi::drivers::decode::microphone
