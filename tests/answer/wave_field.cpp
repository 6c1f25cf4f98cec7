#include "tests/answer/wave_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace yuragi::answer {

WaveField::WaveField(std::size_t size, double edge_m, double rate_hz)
    : fft_(2, size),
      edge_m_(edge_m),
      rate_hz_(rate_hz),
      power_(size * fft_.row_modes(), 0.0),
      turn_(power_.size()),
      first_(power_.size()) {
  for (std::size_t i = 0; i < size; ++i) {
    const double turn_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(size);
    window_.push_back(0.5 * (1.0 - std::cos(turn_rad)));
  }
}

void WaveField::take(const std::vector<double>& heights_m, bool is_second) {
  const std::size_t size = fft_.size();
  for (std::size_t row = 0; row < size; ++row) {
    for (std::size_t column = 0; column < size; ++column) {
      fft_.samples()[row * size + column] = heights_m[row * size + column] * window_[row] * window_[column];
    }
  }
  fft_.forward();
  for (std::size_t i = 0; i < power_.size(); ++i) {
    const std::complex<double> mode = fft_.spectrum()[i];
    power_[i] += std::norm(mode);
    if (is_second) {
      turn_[i] += std::conj(first_[i]) * mode;
    } else {
      first_[i] = mode;
    }
  }
}

/// Calls visit(index, cycles an edge to the east, and to the south).
template <class Visit>
void WaveField::for_each_mode(const Visit& visit) const {
  const std::size_t size = fft_.size();
  const std::size_t half = fft_.row_modes();
  for (std::size_t row = 0; row < size; ++row) {
    const double z = static_cast<double>(row) - (2 * row > size ? static_cast<double>(size) : 0.0);
    for (std::size_t column = 0; column < half; ++column) {
      if (row > 0 || column > 0) visit(row * half + column, static_cast<double>(column), z);
    }
  }
}

WaveField::Strongest WaveField::strongest(Horizontal downwind) const {
  std::vector<double> rings(fft_.size() / 2, 0.0);
  for_each_mode([&](std::size_t i, double x, double z) {
    const auto ring = static_cast<std::size_t>(std::lround(std::hypot(x, z)));
    if (ring < rings.size()) rings[ring] += power_[i];
  });
  // Ring 0 is the mean, and leaks into ring 1.
  const auto top =
      static_cast<std::size_t>(std::distance(rings.begin(), std::max_element(rings.begin() + 2, rings.end())));

  double power = 0.0;
  double cycles = 0.0;
  double going = 0.0;
  double speed_m_s = 0.0;
  for_each_mode([&](std::size_t i, double x, double z) {
    const double length = std::hypot(x, z);
    const auto ring = static_cast<std::size_t>(std::lround(length));
    if (ring + 1 < top || ring > top + 1) return;
    power += power_[i];
    cycles += power_[i] * length;
    const double ahead = (x * downwind.east + z * downwind.south) / length;
    if (std::abs(ahead) < 0.5) return;
    // A wave cos(k x - w t) turns its mode by -w a second; seen from the mirror image of its vector, by w.
    const double frequency_rad_s = -std::arg(turn_[i]) * rate_hz_ * (ahead < 0.0 ? -1.0 : 1.0);
    going += power_[i];
    speed_m_s += power_[i] * frequency_rad_s / (2.0 * std::numbers::pi * length / edge_m_);
  });
  return {edge_m_ * power / cycles, speed_m_s / going};
}

}  // namespace yuragi::answer
