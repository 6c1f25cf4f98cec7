#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/played_wind.hpp"
#include "simulators/simulator.hpp"

namespace yuragi::sim {

/// The names that ModbusSimulator knows devices by.
std::vector<std::string> modbus_device_names();

/// A Modbus TCP server, on libmodbus, with the registers of real devices: what a gateway with those devices behind it
/// looks like. Serves any number of clients.
class ModbusSimulator final : public Simulator {
 public:
  /// Listens at once; port 0 takes a free one. Throws std::runtime_error for a device it does not know or an address
  /// that cannot be had. `seed` makes the bytes of the garbage fault.
  ModbusSimulator(std::string_view device, const std::string& host, std::uint16_t port, std::uint64_t seed,
                  MeasuredWind wind);
  ~ModbusSimulator() override;

  /// The port that it listens on.
  std::uint16_t port() const;

  std::span<const FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<FaultKind> fault) override;
  std::string status() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::sim
