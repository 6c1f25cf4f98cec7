#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/decode/modbus/modbus.hpp"
#include "drivers/modbus/modbus_profile.hpp"

namespace yuragi::drivers::modbus {

enum class ModbusMeasure : std::uint8_t { kSpeed, kDirection, kGust };

/// One request, and the quantities in its reply.
struct ModbusRead {
  decode::modbus::ModbusRequest request;
  std::vector<ModbusMeasure> measures;
  std::vector<std::size_t> stations;  ///< which of ModbusProfile::quantities

  bool contains(ModbusMeasure measure) const;
  /// Returns true if it has a part of the wind, and not only other quantities.
  bool has_wind() const { return !measures.empty(); }
};

/// The requests that read all quantities of a profile, the speed first, those without wind last: as few as the profile
/// allows. Adjacent registers of one slave are read together, those with side effects separately. `is_direction_apart`:
/// the direction is on another line.
std::vector<ModbusRead> plan_modbus_reads(const ModbusProfile& profile, bool is_direction_apart = false);

/// The request that reads this quantity alone.
decode::modbus::ModbusRequest request_for(const decode::modbus::ModbusQuantity& quantity);

/// The quantity of `measure` in the profile, which must have it.
const decode::modbus::ModbusQuantity& quantity_of(const ModbusProfile& profile, ModbusMeasure measure);

/// The part of a reply to `request` that belongs to `quantity`.
std::span<const std::uint16_t> registers_of(const decode::modbus::ModbusQuantity& quantity,
                                            const decode::modbus::ModbusRequest& request,
                                            const decode::modbus::ModbusRegisters& registers);

}  // namespace yuragi::drivers::modbus
