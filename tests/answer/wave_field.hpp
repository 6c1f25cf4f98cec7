#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "engine/fft/real_fft.hpp"
#include "tests/answer/tracks.hpp"

namespace yuragi::answer {

/// Waves of a square of water by wave vector: how strong they are, and how their phases go on in a tick.
class WaveField {
 public:
  /// `size` points an edge of `edge_m`, a point's pitch beyond the last one included; `rate_hz`: of the ticks.
  WaveField(std::size_t size, double edge_m, double rate_hz);

  /// Heights, row by row from north to south; `is_second`: a tick after the ones before.
  void take(const std::vector<double>& heights_m, bool is_second);

  struct Strongest {
    double length_m = 0.0;
    double speed_m_s = 0.0;
  };

  /// The strongest waves: the ring of wave vectors with most power, and its two neighbours. Their speed is the mean of
  /// frequency over wavenumber of those that go within 60 degrees of downwind, weighted by power.
  Strongest strongest(Horizontal downwind) const;

 private:
  template <class Visit>
  void for_each_mode(const Visit& visit) const;

  fft::RealFft fft_;
  double edge_m_, rate_hz_;
  std::vector<double> window_, power_;
  std::vector<std::complex<double>> turn_, first_;
};

}  // namespace yuragi::answer
