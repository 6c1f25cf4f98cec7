#include "daemon/tools/acceptance/simulated_sensor.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "drivers/sensor/driver.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::acceptance {
namespace {

using settings::SensorConfig;

constexpr double kDirectionStep_deg = 1.0;  ///< a simulated device rounds to it

/// `north_offset_deg`: what the driver itself adds to directions.
ExpectedWind expected_wind(const SensorConfig& sensor, double north_offset_deg, double step_m_s) {
  const auto calibrated = [&](double speed_m_s) {
    wind::Reading reading;
    reading.speed_m_s = speed_m_s;
    reading.direction_deg = std::fmod(kSimulatedDirection_deg + north_offset_deg + 360.0, 360.0);
    return sensor.calibration.applied_to(reading);
  };
  const wind::Reading middle = calibrated(kSimulatedSpeed_m_s);
  const double least_m_s = calibrated(kSimulatedSpeed_m_s - step_m_s).speed_m_s;
  const double most_m_s = calibrated(kSimulatedSpeed_m_s + step_m_s).speed_m_s;
  return {.speed_m_s = middle.speed_m_s,
          .speed_tolerance_m_s = std::max(most_m_s - middle.speed_m_s, middle.speed_m_s - least_m_s),
          .direction_deg = middle.direction_deg.value(),
          .direction_tolerance_deg = kDirectionStep_deg};
}

}  // namespace

Result<SimulationPlan, Failure> plan_simulation(const SensorConfig& sensor) {
  auto device = sensor.driver->simulated(sensor.values);
  if (!device) return device.error();
  SimulationPlan plan{.arguments = std::move(device->arguments),
                      .sensor = sensor,
                      .port_key = device->port_key,
                      .expected = expected_wind(sensor, device->north_offset_deg, device->speed_step_m_s)};
  plan.sensor.values = std::move(device->values);
  for (std::string option : {std::string("--speed"), fmt::format("{}", kSimulatedSpeed_m_s), std::string("--direction"),
                             fmt::format("{}", kSimulatedDirection_deg), std::string("--turbulence"), std::string("0")})
    plan.arguments.push_back(std::move(option));
  return plan;
}

SensorConfig at_port(const SimulationPlan& plan, std::uint16_t port) {
  SensorConfig sensor = plan.sensor;
  sensor.values.set(plan.port_key, std::int64_t{port});
  return sensor;
}

std::optional<std::uint16_t> simulator_port(std::string_view output) {
  const std::string_view line = output.substr(0, output.find('\n'));
  const std::size_t colon = line.rfind(':');
  if (line.size() == output.size() || colon == std::string_view::npos) return std::nullopt;
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(line.data() + colon + 1, line.data() + line.size(), port);
  if (error != std::errc{} || port == 0) return std::nullopt;
  return port;
}

}  // namespace yuragi::daemon::tools::acceptance
