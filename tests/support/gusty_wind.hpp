#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi {

/// One pattern of gusts for all tests: it is large.
inline const std::shared_ptr<const wind::turbulence::GustNoise>& shared_gusts() {
  static const auto kGusts = std::make_shared<const wind::turbulence::GustNoise>(
      wind::turbulence::GustNoiseSettings{.samples = 256, .seed = 3});
  return kGusts;
}

/// A steady mean wind and gusts of every length that the ground holds, carried by it.
class GustyWind {
 public:
  /// `deviation_m_s`: of each octave, along the wind and across it.
  GustyWind(wind::Vector mean, float deviation_m_s) : wind_(mean) {
    const double speed_m_s = std::hypot(mean.u_m_s, mean.v_m_s);
    if (speed_m_s > 0.0) wind_.gusts.ahead = (1.0 / speed_m_s) * mean;
    wind_.advection = mean;
    wind_.gusts.along_m_s.fill(deviation_m_s);
    wind_.gusts.across_m_s.fill(deviation_m_s);
  }

  const wind::ground::Wind& step(double dt_s) {
    shared_gusts()->carry(wind_.gusts.carried, wind_.everywhere.u_m_s, -wind_.everywhere.v_m_s, dt_s);
    wind_.tick = ++tick_;
    return wind_;
  }
  const wind::ground::Wind& wind() const { return wind_; }

 private:
  wind::ground::Wind wind_;
  std::uint64_t tick_ = 0;
};

}  // namespace yuragi
