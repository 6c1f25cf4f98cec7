#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulators/core/played_wind.hpp"
#include "simulators/core/simulator.hpp"
#include "simulators/modbus/modbus_devices.hpp"
#include "simulators/modbus/modbus_port.hpp"

namespace yuragi::simulators::modbus {

struct FaultOptions {
  std::optional<std::uint8_t> id;  ///< the only slave with faults; the others work. Freeze and spike are of the
                                   ///< wind, disconnect and unplug of the line: those concern all slaves
  double late_s = 0.8;             ///< the delay of a late reply
  std::uint64_t seed = 1;          ///< of the bytes of the garbage fault
};

/// A bus of Modbus devices with the registers of real ones, over TCP (as a gateway with those devices behind it) or a
/// serial line.
class Simulator final : public core::Simulator {
 public:
  /// Throws std::runtime_error for two slaves of one id.
  Simulator(const std::vector<Slave>& slaves, std::unique_ptr<Port> port, core::MeasuredWind wind,
            const FaultOptions& options = {});
  ~Simulator() override;

  /// The address or path at which it is reached.
  std::string name() const;

  std::span<const core::FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::simulators::modbus
