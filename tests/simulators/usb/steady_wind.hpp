#pragma once

#include <memory>
#include <vector>

#include "simulators/core/played_wind.hpp"
#include "simulators/usb/usb_port.hpp"
#include "tests/simulators/usb/echo_device.hpp"

namespace yuragi::simulators::usb {

/// The same wind all the time.
class SteadyWind final : public core::PlayedWind {
 public:
  explicit SteadyWind(core::PlayedMoment moment) : moment_(moment) {}
  core::PlayedMoment at(double /*time_s*/) override { return moment_; }

 private:
  core::PlayedMoment moment_;
};

inline core::MeasuredWind steady_wind(double speed_m_s, double direction_deg) {
  return core::MeasuredWind(std::make_unique<SteadyWind>(core::PlayedMoment{speed_m_s, direction_deg}));
}

inline std::unique_ptr<Port> echo_port() {
  return std::make_unique<Port>(std::make_unique<EchoDevice>(), steady_wind(7.5, 240.0));
}

inline std::vector<std::unique_ptr<Port>> echo_ports(std::size_t count) {
  std::vector<std::unique_ptr<Port>> ports;
  for (std::size_t i = 0; i < count; ++i) ports.push_back(echo_port());
  return ports;
}

}  // namespace yuragi::simulators::usb
