#include "engine/noise/band_limited_tile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "engine/fft/real_fft.hpp"
#include "engine/math/portable.hpp"
#include "engine/noise/noise_spectrum.hpp"

namespace yuragi::noise {
namespace {

/// The remaining share of a wave of k cycles an edge when waves of `end` and more are removed.
double passed(double k, double end) noexcept {
  if (k >= end) return 0.0;
  if (k <= 0.5 * end) return 1.0;
  const double octave = std::log2(end / k);
  return octave * octave * (3.0 - 2.0 * octave);
}

Tile2 without_waves_from(double end, const Tile2& base, fft::RealFft& fft) {
  for (std::size_t i = 0; i < base.values.size(); ++i) fft.samples()[i] = static_cast<double>(base.values[i]);
  fft.forward();
  const std::size_t columns = fft.row_modes();
  for (std::size_t i = 0; i < fft.spectrum().size(); ++i) {
    const std::size_t row = i / columns;  // of the spectrum
    const auto wave_z = static_cast<double>(spectrum_row(row, base.size, 2).wave_z);
    fft.spectrum()[i] *= passed(math::length(static_cast<double>(i % columns), wave_z), end);
  }
  fft.inverse();

  // The transform and its inverse multiply by the number of samples.
  const Standard scale{0.0, 1.0 / static_cast<double>(base.values.size())};
  return {base.size, values_on_grid(fft.samples(), scale)};
}

}  // namespace

BandLimitedTile2::BandLimitedTile2(Tile2 base, std::size_t levels) {
  if (!is_readable(base)) throw std::invalid_argument("a band-limited noise needs a readable tile");
  if (levels < 1 || levels > kMaxLevels) throw std::invalid_argument("a band-limited noise must have 1 to 8 levels");
  levels_.reserve(levels);
  levels_.push_back(std::move(base));
  fft::RealFft fft(2, levels_[0].size);
  for (std::size_t index = 1; index < levels; ++index) {
    levels_.push_back(without_waves_from(end_cycles(index), levels_[0], fft));
  }
}

double BandLimitedTile2::end_cycles(std::size_t index) const noexcept {
  return std::ldexp(static_cast<double>(levels_[0].size) * std::numbers::sqrt2 / 2.0, -static_cast<int>(index));
}

BandPick BandLimitedTile2::pick(double speed_m_s, double rate_hz, double period_m) const noexcept {
  // Waves are shown up to rate period / (2 speed) cycles an edge. Over the octave before that, a level is replaced by
  // the next.
  const double shown_per_end = rate_hz * period_m / (2.0 * speed_m_s * end_cycles(0));
  const auto last = static_cast<double>(levels_.size() - 1);
  const double place = shown_per_end > 2.0 ? 0.0 : std::clamp(1.0 - std::log2(shown_per_end), 0.0, last);
  const auto level = static_cast<std::size_t>(place);
  return {.level = level,
          .next = std::min(level + 1, levels_.size() - 1),
          .weight = static_cast<float>(place - static_cast<double>(level))};
}

}  // namespace yuragi::noise
