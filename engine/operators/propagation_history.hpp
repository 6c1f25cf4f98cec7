#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace yuragi::operators {

/// What some values were up to a while ago: the noise's history, which propagation runs along a chain.
///
/// The past is kept as samples at even intervals, whatever the ticks are, and the present apart; between them it is a
/// straight line. So what is read moves no faster than what was written: if every value changes by at most r in a
/// second, then what stands at a set delay does so too, over any ticks. Before the first push() all has been 0 for
/// ever. Width and longest delay are set when it is made; it allocates then, never afterwards. Thread-safe: no.
/// Realtime-safe: yes.
class PropagationHistory {
 public:
  /// Far more often than anything that cloth lets through.
  static constexpr double kSampleRate_hz = 60.0;

  /// For `width` values and delays up to `longest_s` (0 to 1000). May throw std::bad_alloc.
  PropagationHistory(std::size_t width, double longest_s);

  std::size_t width() const noexcept { return width_; }

  /// Advances by dt_s (above 0; else nothing happens) to `values`, which has width() elements.
  void push(std::span<const float> values, double dt_s) noexcept;

  /// Two rows of width() values with the wanted one on the straight line between them.
  struct Between {
    const float* newer = nullptr;
    const float* older = nullptr;
    float fraction = 0.0F;  ///< from newer to older, 0 to 1
  };

  /// The values of delay_s ago (at least 0; what is longer than the longest delay is taken as that). Valid until the
  /// next push().
  Between at(double delay_s) const noexcept;

 private:
  /// Where the sample stands that is `age` (below count_) older than the newest.
  std::size_t sample(std::size_t age) const noexcept {
    const std::size_t row = latest_ + age;
    return (row < count_ ? row : row - count_) * width_;
  }

  std::size_t width_;
  std::size_t count_;           ///< of samples
  std::vector<float> samples_;  ///< a ring, a row of width_ a sample; newer ones stand before older ones
  std::vector<float> present_;
  std::size_t latest_ = 0;  ///< the newest sample's row
  double phase_ = 0.0;      ///< the present's distance from the newest sample, in intervals, [0, 1)
};

}  // namespace yuragi::operators
