#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/decode/microphone/mic_block.hpp"
#include "engine/fft/real_fft.hpp"

namespace yuragi::drivers::decode::microphone {

struct MicAnalyserOptions {
  double rate_hz = 48000.0;  ///< above 0
  std::size_t channels = 1;  ///< 1 to kMicMaxChannels
  double low_hz = 20.0;      ///< the wind's band, 0 < low < high
  double high_hz = 200.0;    ///< limited by the sample rate
};

/// Sound to MicBlocks: Hann segments of an eighth to a quarter of a second that overlap by half, each without its mean
/// (the DC block), and of each the power in bands a third of an octave wide, and the cross powers of each pair of
/// channels. A block every quarter of a second.
///
/// Thread-safe: no. Realtime-safe after construction: yes (no allocation), but meant for a thread that may be late.
/// Throws std::invalid_argument for options out of range or a band that the rate cannot show.
class MicAnalyser {
 public:
  explicit MicAnalyser(const MicAnalyserOptions& options);

  /// The format of the blocks; the caller sets the device's name.
  const MicHello& hello() const noexcept { return hello_; }

  /// One frame, a sample a channel. Returns a block when that completes one; its time stamp and lost samples are the
  /// caller's to fill in. A sample that is not finite, or beyond ten times full scale, counts as 0 and as invalid.
  std::optional<MicBlock> add(std::span<const float> frame) noexcept;

  /// After lost samples: drops the present segment, because its parts do not belong together.
  void restart() noexcept;

 private:
  void add_segment() noexcept;
  void add_band_powers() noexcept;
  MicBlock finish_block() noexcept;

  std::size_t channels_;
  std::size_t segment_;  ///< samples, even
  std::size_t segments_per_block_;
  std::vector<double> window_;
  double scale_ = 0.0;                   ///< from |F|^2 to mean square
  std::vector<std::size_t> band_edges_;  ///< bins; band b is [edge b, edge b + 1)
  std::size_t high_begin_ = 0, high_end_ = 0;
  MicHello hello_;

  fft::RealFft fft_;
  std::vector<float> history_;  ///< the segment that is being filled, frames one after the other
  std::size_t filled_ = 0;      ///< frames
  std::vector<std::vector<std::complex<double>>> spectra_;

  // Sums over the block that is under way.
  struct Sums {
    std::array<double, kMicMaxBands> power{};
    double high_power = 0.0;
    double total_power = 0.0;
    double peak = 0.0;
    std::uint32_t clipped = 0;
  };
  std::array<Sums, kMicMaxChannels> sums_{};
  std::array<std::array<std::complex<double>, kMicMaxBands>, kMicMaxPairs> cross_sums_{};
  std::uint16_t segments_ = 0;
  std::uint32_t block_frames_ = 0;
  std::uint32_t invalid_ = 0;
  std::uint64_t samples_ = 0;
};

}  // namespace yuragi::drivers::decode::microphone
