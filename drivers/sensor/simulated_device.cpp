#include "drivers/sensor/simulated_device.hpp"

#include <cstdint>
#include <utility>

#include <fmt/format.h>

namespace yuragi::drivers::sensor {
namespace {

constexpr const char* kHost = "127.0.0.1";

SimulatedDevice at_place(std::string subcommand, std::string option, std::string place, ParameterValues values,
                         const std::vector<std::string>& options) {
  SimulatedDevice device{.arguments = {std::move(subcommand), std::move(option), std::move(place)},
                         .values = std::move(values)};
  device.arguments.insert(device.arguments.end(), options.begin(), options.end());
  device.values.set("host", std::string(kHost));
  return device;
}

}  // namespace

SimulatedDevice simulated_server(std::string subcommand, ParameterValues values,
                                 const std::vector<std::string>& options) {
  return at_place(std::move(subcommand), "--tcp", fmt::format("{}:0", kHost), std::move(values), options);
}

SimulatedDevice simulated_by_tcp(std::string subcommand, ParameterValues values,
                                 const std::vector<std::string>& options) {
  SimulatedDevice device = simulated_server(std::move(subcommand), std::move(values), options);
  device.values.set("transport", std::string("tcp"));
  device.values.set("device", std::string());
  return device;
}

SimulatedDevice simulated_sender(std::string subcommand, std::string option, ParameterValues values,
                                 const std::vector<std::string>& options) {
  std::string place = fmt::format("{}:{}", kHost, values.integer("port"));
  SimulatedDevice device =
      at_place(std::move(subcommand), std::move(option), std::move(place), std::move(values), options);
  device.values.set("from", std::string(kHost));
  return device;
}

}  // namespace yuragi::drivers::sensor
