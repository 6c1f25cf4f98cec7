#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/sensor/driver.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::test {

/// The Modbus driver's sensor, as the daemon opens it.
inline std::unique_ptr<drivers::sensor::Sensor> open_modbus_sensor(ParameterValues::Map given) {
  given.try_emplace("profile_dir", source_path("drivers/modbus/profiles"));
  return driver_named("modbus").open(values_for("modbus", given));
}

/// yuragi-sim modbus, on a free TCP port or as a serial port.
class ModbusSimulatorProgram {
 public:
  enum class Transport { kTcp, kRtu };

  ModbusSimulatorProgram(Transport transport, const std::vector<std::string>& options)
      : is_rtu_(transport == Transport::kRtu), process_([&] {
          std::vector<std::string> command = {built_path("bin/yuragi-sim"), "modbus"};
          if (is_rtu_) {
            command.insert(command.end(), {"--rtu", "--link", (folder_ / "bus").string()});
          } else {
            command.insert(command.end(), {"--tcp", "127.0.0.1:0"});
          }
          command.insert(command.end(), options.begin(), options.end());
          return command;
        }()) {
    where_ = process_.line_after(is_rtu_ ? "serving " : "listening on 127.0.0.1:");
  }

  /// The parameters of a sensor that reaches it.
  ParameterValues::Map parameters() const {
    if (is_rtu_) return {{"transport", std::string("rtu")}, {"device", where_}};
    return {{"port", std::int64_t{std::stoi(where_)}}};
  }
  /// The TCP port, or the serial port's path.
  const std::string& where() const { return where_; }
  ChildProcess& process() { return process_; }

  /// Types a fault and waits until it holds.
  void suffer(const std::string& fault) {
    process_.type(fault + " 600");
    process_.line_after(fault + " for 600 s");
  }
  void be_well() {
    process_.type("clear");
    process_.line_after("no faults");
  }

 private:
  bool is_rtu_;
  TemporaryFolder folder_;
  ChildProcess process_;
  std::string where_;
};

}  // namespace yuragi::test
