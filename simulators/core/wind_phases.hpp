#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulators/core/played_wind.hpp"

namespace yuragi::simulators::core {

/// The wind from a moment until the next phase begins.
struct WindPhase {
  double start_s = 0.0;
  double ramp_s = 0.0;  ///< from `start_s` on: duration of the transition from the previous phase
  wind::turbulence::SyntheticWindSettings synthetic;
  std::string recording;  ///< a .windlog, played from its beginning; empty: the synthetic wind
};

/// The phases one after the other. The first begins at 0, and each ramp ends before the next phase begins. In a ramp
/// the wind goes as a vector from the phase before, which still blows, to the new one, by the share r of the ramp that
/// has passed: 3 r^2 - 2 r^3. Throws std::runtime_error if a recording cannot be played.
std::unique_ptr<PlayedWind> play_phases(const std::vector<WindPhase>& phases);

}  // namespace yuragi::simulators::core
