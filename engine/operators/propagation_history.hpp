#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/state_pass.hpp"

namespace yuragi::operators {

/// The recent history of some values: the noise that propagates along a chain.
///
/// The past is stored as samples at even intervals, independent of the ticks, and the present separately; between them
/// it is linear. So values are read with at most the rate at which they were written: if every value changes by at most
/// r per second, a value at a fixed delay does, too. Before the first push() all values are 0. Width and maximum delay
/// are set at construction; it allocates then, never afterwards. Thread-safe: no. Realtime-safe: yes.
class PropagationHistory {
 public:
  /// Far above all frequencies of cloth.
  static constexpr double kSampleRate_hz = 60.0;

  /// For `width` values and delays up to `longest_s` (0 to 1000). May throw std::bad_alloc.
  PropagationHistory(std::size_t width, double longest_s);

  std::size_t width() const noexcept { return width_; }

  /// Advances by dt_s to `values`, which has width() elements. Does nothing if dt_s is not above 0.
  void push(std::span<const float> values, double dt_s) noexcept;

  /// Two rows of width() values with the wanted one on the straight line between them.
  struct Between {
    const float* newer = nullptr;
    const float* older = nullptr;
    float fraction = 0.0F;  ///< from newer to older, 0 to 1
  };

  /// The values of delay_s ago (at least 0; limited to the maximum delay). Valid until the next push().
  Between at(double delay_s) const noexcept;

  void list_state(StatePass& pass) {
    pass(samples_, present_);
    pass.index(latest_, count_);
    pass.within(phase_, 0.0, 1.0);
  }

 private:
  /// The place of the sample that is `age` (below count_) older than the newest.
  std::size_t sample(std::size_t age) const noexcept {
    const std::size_t row = latest_ + age;
    return (row < count_ ? row : row - count_) * width_;
  }

  std::size_t width_;
  std::size_t count_;           ///< of samples
  std::vector<float> samples_;  ///< a ring with a row of width_ per sample; newer rows are before older ones
  std::vector<float> present_;
  std::size_t latest_ = 0;  ///< the newest sample's row
  double phase_ = 0.0;      ///< the present's distance from the newest sample, in intervals, [0, 1)
};

}  // namespace yuragi::operators
