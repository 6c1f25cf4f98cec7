#include "tests/answer/repeats.hpp"

#include <cmath>
#include <complex>

#include "engine/fft/real_fft.hpp"
#include "tests/answer/spectra.hpp"

namespace yuragi::answer {

Repeat largest_repeat(const Series& series, double rate_hz, double least_s) {
  const Series quick = high_passed(series, rate_hz, 0.1);
  const std::size_t count = quick.size();
  if (count == 0) return {};

  // Sums of products at each lag, by a transform of twice the length, half of it zero (Wiener and Khinchin).
  fft::RealFft fft(1, 2 * count);
  for (std::size_t i = 0; i < 2 * count; ++i) fft.samples()[i] = i < count ? static_cast<double>(quick[i]) : 0.0;
  fft.forward();
  for (std::complex<double>& line : fft.spectrum()) line = std::norm(line);
  fft.inverse();

  // Of the two stretches that are compared, the power of each.
  std::vector<double> squares(count + 1, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    squares[i + 1] = squares[i] + static_cast<double>(quick[i]) * static_cast<double>(quick[i]);
  }
  Repeat largest;
  for (auto lag = static_cast<std::size_t>(std::llround(least_s * rate_hz)); lag <= count / 2; ++lag) {
    const double product = fft.samples()[lag] / static_cast<double>(2 * count);
    const double power = squares[count - lag] * (squares[count] - squares[lag]);
    const double correlation = power > 0.0 ? product / std::sqrt(power) : 0.0;
    if (correlation > largest.correlation) largest = {static_cast<double>(lag) / rate_hz, correlation};
  }
  return largest;
}

}  // namespace yuragi::answer
