#pragma once

#include "simulators/played_wind.hpp"

namespace yuragi {

/// A wind that stands still.
class StillWind final : public simulators::PlayedWind {
 public:
  explicit StillWind(simulators::PlayedMoment moment) : moment_(moment) {}
  simulators::PlayedMoment at(double /*time_s*/) override { return moment_; }

 private:
  simulators::PlayedMoment moment_;
};

}  // namespace yuragi
