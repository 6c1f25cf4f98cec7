#pragma once

#include "simulators/core/played_wind.hpp"

namespace yuragi {

/// A wind that stands still.
class StillWind final : public simulators::core::PlayedWind {
 public:
  explicit StillWind(simulators::core::PlayedMoment moment) : moment_(moment) {}
  simulators::core::PlayedMoment at(double /*time_s*/) override { return moment_; }

 private:
  simulators::core::PlayedMoment moment_;
};

}  // namespace yuragi
