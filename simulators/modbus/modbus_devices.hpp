#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/core/played_wind.hpp"

namespace yuragi::simulators::modbus {

/// The wind, as devices report it.
struct Air {
  double speed_m_s = 0.0;
  double direction_deg = 0.0;  ///< where it comes from
  double gust_m_s = 0.0;       ///< the strongest of the last seconds
  double lull_m_s = 0.0;       ///< the weakest of them
  double mean_m_s = 0.0;
  // Constant values of stations that measure more than wind.
  double temperature_c = -3.7;
  double humidity_percent = 64.0;
  double pressure_hpa = 1009.0;
  double rain_mm = 12.6;
};

/// The content of a device's registers: 16 bits for each address, as on the wire.
class RegisterBank {
 public:
  void set(int address, double value);        ///< as a whole number of 16 bits, negative ones in two's complement
  void set_two(int address, double value);    ///< as a whole number of 32 bits in two registers, the high one first
  void set_float(int address, double value);  ///< in two registers, the high one first
  void set_float_low_word_first(int address, double value);  ///< the low one first
  void set_bits(int address, std::uint16_t bits) { registers_[static_cast<std::uint16_t>(address)] = bits; }

  /// Returns nullopt if the register does not exist.
  std::optional<std::uint16_t> at(std::uint16_t address) const;

 private:
  std::map<std::uint16_t, std::uint16_t> registers_;
};

/// One slave of a simulated bus.
struct Slave {
  std::uint8_t id = 1;        ///< from the factory
  std::uint8_t function = 3;  ///< the only one that it supports: 3 or 4
  void (*measure)(const Air& air, RegisterBank& registers) = nullptr;
  /// Reading this register clears lull, mean and gust; 0: there is no such register.
  std::uint16_t clearing_register = 0;
};

/// The names of all devices.
std::vector<std::string> modbus_device_names();

/// The slaves of a device: "NAME", or "NAME@ID" with the id of its first one; further slaves of the same device follow
/// it. Throws std::runtime_error for an unknown name and for an id that no slave can have.
std::vector<Slave> modbus_slaves(std::string_view name_and_id);

}  // namespace yuragi::simulators::modbus
