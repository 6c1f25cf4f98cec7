#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/decode/modbus/modbus.hpp"
#include "drivers/modbus/modbus_profile.hpp"

namespace yuragi::drivers::modbus {

enum class Measure : std::uint8_t { kSpeed, kDirection, kGust };

/// One request, and the quantities in its reply.
struct RegisterRead {
  decode::modbus::Request request;
  std::vector<Measure> measures;
  std::vector<std::size_t> stations;  ///< which of Profile::quantities

  bool contains(Measure measure) const;
  /// Returns true if it has a part of the wind, and not only other quantities.
  bool has_wind() const { return !measures.empty(); }
};

/// The requests that read all quantities of a profile, the speed first, those without wind last: as few as the profile
/// allows. Adjacent registers of one slave are read together, those with side effects separately. `is_direction_apart`:
/// the direction is on another line.
std::vector<RegisterRead> plan_modbus_reads(const Profile& profile, bool is_direction_apart = false);

/// The request that reads this quantity alone.
decode::modbus::Request request_for(const decode::modbus::Quantity& quantity);

/// The quantity of `measure` in the profile, which must have it.
const decode::modbus::Quantity& quantity_of(const Profile& profile, Measure measure);

/// The part of a reply to `request` that belongs to `quantity`.
std::span<const std::uint16_t> registers_of(const decode::modbus::Quantity& quantity,
                                            const decode::modbus::Request& request,
                                            const decode::modbus::Registers& registers);

}  // namespace yuragi::drivers::modbus
