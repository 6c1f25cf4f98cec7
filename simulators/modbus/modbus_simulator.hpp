#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulators/modbus/modbus_devices.hpp"
#include "simulators/modbus/modbus_port.hpp"
#include "simulators/played_wind.hpp"
#include "simulators/simulator.hpp"

namespace yuragi::simulators::modbus {

struct ModbusFaultOptions {
  std::optional<std::uint8_t> id;  ///< the only slave with faults; the others work. Freeze and spike are of the
                                   ///< wind, disconnect and unplug of the line: those concern all slaves
  double late_s = 0.8;             ///< the delay of a late reply
  std::uint64_t seed = 1;          ///< of the bytes of the garbage fault
};

/// A bus of Modbus devices with the registers of real ones, over TCP (as a gateway with those devices behind it) or a
/// serial line.
class ModbusSimulator final : public Simulator {
 public:
  /// Throws std::runtime_error for two slaves of one id.
  ModbusSimulator(const std::vector<ModbusSlave>& slaves, std::unique_ptr<ModbusPort> port, MeasuredWind wind,
                  const ModbusFaultOptions& options = {});
  ~ModbusSimulator() override;

  /// The address or path at which it is reached.
  std::string name() const;

  std::span<const FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<FaultKind> fault) override;
  std::string status() const override;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::simulators::modbus
