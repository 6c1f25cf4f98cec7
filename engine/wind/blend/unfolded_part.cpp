#include "engine/wind/blend/unfolded_part.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/portable.hpp"
#include "engine/wind/turbulence/sampled_turbulence.hpp"

namespace yuragi::wind::blend {
namespace {

constexpr double kMinPart = 1e-3;

}  // namespace

void UnfoldedPart::set(double interval_s, double time_scale_s) noexcept {
  interval_s_ = interval_s;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double octave = kFirstOctave + static_cast<double>(i) / static_cast<double>(kAnOctave);
    parts_[i] = std::max(kMinPart, turbulence::von_karman_unfolded_part(math::power_of_two(octave) / interval_s,
                                                                        interval_s, time_scale_s));
  }
}

double UnfoldedPart::at(double frequency_hz) const noexcept {
  const double octave = std::log2(std::max(1e-9, frequency_hz * interval_s_));
  const double place =
      std::clamp((octave - kFirstOctave) * static_cast<double>(kAnOctave), 0.0, static_cast<double>(kPoints - 1));
  const auto below = std::min(static_cast<std::size_t>(place), kPoints - 2);
  return std::lerp(parts_[below], parts_[below + 1], place - static_cast<double>(below));
}

}  // namespace yuragi::wind::blend
