#include "daemon/tools/acceptance/simulated_sensor.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "drivers/sensor/driver.hpp"
#include "engine/base/units.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::acceptance {
namespace {

using settings::SensorConfig;

constexpr std::string_view kHost = "127.0.0.1";

// What a simulated device says is rounded; half a step would do, a whole one leaves room for units.
constexpr double kSpeedStep_m_s = 0.1;
constexpr double kDirectionStep_deg = 1.0;

/// `north_offset_deg`: what the driver itself adds to directions.
ExpectedWind expected_wind(const SensorConfig& sensor, double north_offset_deg, double step_m_s = kSpeedStep_m_s) {
  const auto calibrated = [&](double speed_m_s) {
    wind::WindReading reading;
    reading.speed_m_s = speed_m_s;
    reading.direction_deg = std::fmod(kSimulatedDirection_deg + north_offset_deg + 360.0, 360.0);
    return sensor.calibration.applied_to(reading);
  };
  const wind::WindReading middle = calibrated(kSimulatedSpeed_m_s);
  const double least_m_s = calibrated(kSimulatedSpeed_m_s - step_m_s).speed_m_s;
  const double most_m_s = calibrated(kSimulatedSpeed_m_s + step_m_s).speed_m_s;
  return {.speed_m_s = middle.speed_m_s,
          .speed_tolerance_m_s = std::max(most_m_s - middle.speed_m_s, middle.speed_m_s - least_m_s),
          .direction_deg = middle.direction_deg.value(),
          .direction_tolerance_deg = kDirectionStep_deg};
}

/// The plan for a subcommand of yuragi-sim with an option that says where it listens, or sends to.
SimulationPlan plan_of_place(const SensorConfig& sensor, std::string subcommand, std::string option, std::string place,
                             const std::vector<std::string>& device_options = {}) {
  SimulationPlan plan{.arguments = {std::move(subcommand), std::move(option), std::move(place)},
                      .sensor = sensor,
                      .expected = expected_wind(sensor, 0.0)};
  plan.arguments.insert(plan.arguments.end(), device_options.begin(), device_options.end());
  for (std::string wind_option :
       {std::string("--speed"), fmt::format("{}", kSimulatedSpeed_m_s), std::string("--direction"),
        fmt::format("{}", kSimulatedDirection_deg), std::string("--turbulence"), std::string("0")})
    plan.arguments.push_back(std::move(wind_option));
  return plan;
}

/// The plan for a subcommand that listens at TCP, of a driver that has several transports.
SimulationPlan plan_of(const SensorConfig& sensor, std::string subcommand,
                       const std::vector<std::string>& device_options) {
  SimulationPlan plan =
      plan_of_place(sensor, std::move(subcommand), "--tcp", fmt::format("{}:0", kHost), device_options);
  plan.sensor.values.set("transport", std::string("tcp"));
  plan.sensor.values.set("host", std::string(kHost));
  plan.sensor.values.set("device", std::string());
  return plan;
}

Result<SimulationPlan, Failure> plan_modbus(const SensorConfig& sensor) {
  const ParameterValues& values = sensor.values;
  const std::int64_t speed_slave = values.integer("speed_slave");
  const std::int64_t direction_slave = values.integer("direction_slave");
  if (!values.text("direction_device").empty())
    return Failure{"yuragi-sim plays one line, and its vane is on a line of its own"};
  if (direction_slave != 0 && direction_slave != speed_slave && direction_slave != speed_slave + 1)
    return Failure{"yuragi-sim plays only a direction_slave that is the speed_slave of its entry, or the next"};
  if (direction_slave != 0 && speed_slave == 0)
    return Failure{"yuragi-sim plays a direction_slave only where its entry has a speed_slave, too"};
  std::string device = std::filesystem::path(values.text("profile")).stem().string();
  if (speed_slave != 0) device += fmt::format("@{}", speed_slave);
  SimulationPlan plan = plan_of(sensor, "modbus", {"--profile", device});
  plan.sensor.values.set("direction_device", std::string());
  return plan;
}

/// What yuragi-sim sends for the formats and sentences that a sensor takes.
std::string nmea_formats(const ParameterValues& values) {
  const std::string& format = values.text("format");
  if (format != "auto" && format != "nmea") return format;
  std::string sentences;
  for (const char c : values.text("sentences")) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0)
      sentences += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (!sentences.empty()) return sentences;
  if (values.text("reference") == "north") return "mwd";
  return values.text("reference") == "true" ? "vwt" : "mwv";
}

Result<SimulationPlan, Failure> plan_nmea(const SensorConfig& sensor) {
  const std::string formats = nmea_formats(sensor.values);
  const std::string& reference = sensor.values.text("reference");
  SimulationPlan plan = plan_of(sensor, "nmea", {"--format", formats});
  // The simulator's own names, which are no fault of the configuration.
  plan.sensor.values.set("talker", std::string());
  plan.sensor.values.set("address", std::string("01"));
  plan.sensor.values.set("xdr_id", std::int64_t{0});
  const bool says_north = formats.find("mwd") != std::string::npos || formats.find("mda") != std::string::npos;
  const bool is_from_north = says_north && (reference == "north" || reference == "auto");
  plan.expected = expected_wind(sensor, is_from_north ? 0.0 : sensor.values.number("north_offset"));
  return plan;
}

Result<SimulationPlan, Failure> plan_line(const SensorConfig& sensor) {
  const ParameterValues& values = sensor.values;
  const bool has_keys = values.text("format") == "keys";
  const std::int64_t direction_column = values.integer("direction_column");
  const std::string& direction_key = values.text("direction_key");
  const bool is_laid_out_so =
      has_keys ? values.text("speed_key") == "speed" && (direction_key.empty() || direction_key == "direction")
               : values.text("separator") == "comma" && values.integer("speed_column") == 1 &&
                     (direction_column == 0 || direction_column == 2) && values.integer("gust_column") == 0;
  const bool has_plain_numbers = values.text("speed_unit") == "m/s" && values.number("speed_scale") == 1.0 &&
                                 values.number("speed_offset") == 0.0 && values.number("direction_scale") == 1.0;
  if (!is_laid_out_so || !has_plain_numbers)
    return Failure{"yuragi-sim plays only lines of speed and direction in m/s and degrees, 4.2,270"};
  SimulationPlan plan = plan_of(sensor, "line", {"--format", has_keys ? "key-value" : "csv"});
  plan.expected = expected_wind(sensor, values.number("north_offset"));
  return plan;
}

SimulationPlan plan_davis(const SensorConfig& sensor) {
  SimulationPlan plan = plan_of(sensor, "davis", {});
  plan.expected = expected_wind(sensor, 0.0, kMetresPerSecondPerMph);  // it says whole miles per hour
  return plan;
}

/// Stations that speak every 3 to 16 s would say too little in the time that there is.
constexpr std::array<std::string_view, 2> kOftenEnough = {"--interval", "1"};

/// The plan for a subcommand that sends to where the sensor listens, at the port that is configured.
SimulationPlan plan_of_sender(const SensorConfig& sensor, std::string subcommand, std::string option) {
  const std::string to = fmt::format("{}:{}", kHost, sensor.values.integer("port"));
  SimulationPlan plan = plan_of_place(sensor, std::move(subcommand), std::move(option), to);
  plan.sensor.values.set("host", std::string(kHost));
  plan.sensor.values.set("from", std::string(kHost));
  return plan;
}

SimulationPlan plan_tempest(const SensorConfig& sensor) {
  SimulationPlan plan = plan_of_sender(sensor, "tempest", "--udp");
  plan.arguments.insert(plan.arguments.end(), kOftenEnough.begin(), kOftenEnough.end());
  const std::string& station = sensor.values.text("serial_number");
  if (!station.empty()) plan.arguments.insert(plan.arguments.end(), {"--station", station});
  return plan;
}

SimulationPlan plan_ecowitt(const SensorConfig& sensor) {
  SimulationPlan plan = plan_of_place(sensor, "ecowitt", "--tcp", fmt::format("{}:0", kHost));
  plan.sensor.values.set("host", std::string(kHost));
  plan.arguments.insert(plan.arguments.end(), kOftenEnough.begin(), kOftenEnough.end());
  plan.sensor.values.set("sensor_interval", 1.0);
  plan.sensor.values.set("poll_interval", 0.5);
  return plan;
}

SimulationPlan plan_ecowitt_push(const SensorConfig& sensor) {
  SimulationPlan plan = plan_of_sender(sensor, "ecowitt-push", "--to");
  plan.arguments.insert(plan.arguments.end(), kOftenEnough.begin(), kOftenEnough.end());
  const std::string& path = sensor.values.text("path");
  if (!path.empty()) plan.arguments.insert(plan.arguments.end(), {"--path", path});
  // No key on a command line, which others can see.
  plan.sensor.values.set("station_key", Secret());
  return plan;
}

SimulationPlan plan_weatherlink(const SensorConfig& sensor) {
  SimulationPlan plan = plan_of_place(sensor, "weatherlink-live", "--tcp", fmt::format("{}:0", kHost));
  plan.arguments.insert(plan.arguments.end(), {"--udp", fmt::format("{}:{}", kHost, sensor.values.integer("port"))});
  plan.arguments.insert(plan.arguments.end(), kOftenEnough.begin(), kOftenEnough.end());
  plan.sensor.values.set("host", std::string(kHost));
  plan.sensor.values.set("transmitter", std::int64_t{0});
  return plan;
}

}  // namespace

Result<SimulationPlan, Failure> plan_simulation(const SensorConfig& sensor) {
  const std::string_view driver = sensor.driver->name;
  if (driver == "modbus") return plan_modbus(sensor);
  if (driver == "nmea") return plan_nmea(sensor);
  if (driver == "line") return plan_line(sensor);
  if (driver == "davis") return plan_davis(sensor);
  if (driver == "weatherlink") return plan_weatherlink(sensor);
  if (driver == "tempest") return plan_tempest(sensor);
  if (driver == "ecowitt") return plan_ecowitt(sensor);
  if (driver == "ecowitt-push") return plan_ecowitt_push(sensor);
  constexpr std::array<std::string_view, 3> kNeedDevices = {"hid", "usb", "microphone"};
  if (std::ranges::find(kNeedDevices, driver) != kNeedDevices.end())
    return Failure{fmt::format("a simulated {} needs USB or sound of its own, and rights for it", driver)};
  return Failure{fmt::format("there is no simulated device for the driver {}", driver)};
}

SensorConfig at_port(SensorConfig sensor, std::uint16_t port) {
  // A WeatherLink Live's `port` is where its broadcasts come.
  sensor.values.set(sensor.driver->name == "weatherlink" ? "http_port" : "port", std::int64_t{port});
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
