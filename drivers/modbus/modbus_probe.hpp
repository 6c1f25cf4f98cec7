#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/bus/modbus_connection.hpp"
#include "drivers/modbus/modbus_profile.hpp"

namespace yuragi::drivers::modbus {

/// A profile and its name in a configuration.
struct NamedModbusProfile {
  std::string name;
  Profile profile;
};

/// Where to look for Modbus devices.
struct ProbePlan {
  /// The same port or host with each of its possible settings, the likeliest first.
  std::vector<bus::ModbusLine> lines;
  std::vector<std::uint8_t> ids;  ///< slave ids to try
  std::vector<NamedModbusProfile> profiles;
  Nanoseconds response_timeout = std::chrono::milliseconds(200);
  bool tries_all_lines = false;  ///< continue after a line on which a slave replied
};

/// The device's own wind force, compared with the speed that a profile reads.
enum class ForceVerdict : std::uint8_t {
  kNone,         ///< there is none, or it is 0: no comparison
  kAgrees,       ///< they are the same, to within one Beaufort
  kContradicts,  ///< the profile's scale is wrong
};

/// A profile for whose registers a device replies with plausible values.
struct Fit {
  std::string profile;  ///< by the name that a configuration uses
  std::string device;
  std::optional<double> speed_m_s;  ///< empty: only the vane of a pair
  /// Empty beside a `direction_slave`: only the cup of a pair, or no direction at present.
  std::optional<double> direction_deg;
  std::optional<double> gust_m_s;
  std::optional<double> beaufort;  ///< the device's own wind force
  ForceVerdict verdict = ForceVerdict::kNone;
  std::uint8_t speed_slave = 1;
  std::optional<std::uint8_t> direction_slave;
  bool is_at_home = false;  ///< line settings and ids are those of the profile itself
};

/// Returns true if any value is not 0. A profile of another device often reads zeros.
bool is_live(const Fit& fit);

/// A slave that replied.
struct Hit {
  bus::ModbusLine line;
  std::uint8_t id = 0;
  /// The best first: those that read more than zeros, those that the device's own wind force does not contradict, those
  /// with most quantities, those with factory settings. None: a device that no profile knows. One half of a pair only
  /// if nothing else fits.
  std::vector<Fit> fits;
  /// The names of the profiles, the best first, that read the same register with different scales, if the device does
  /// not show which is right. Empty: there is no such doubt.
  std::vector<std::string> scale_doubts;
};

/// Called with the progress: what is about to be tried, and the part of all that is done, 0 to 1.
using ProbeProgress = std::function<void(const bus::ModbusLine& line, std::uint8_t id, double done)>;
/// Called with each slave that is found, at once.
using ProbeFound = std::function<void(const Hit& hit)>;

/// Requests a register or two from every id on every line, and the profiles' registers from those that reply. Reads
/// only, and leaves out every profile in which a reading has side effects. Returns how many slaves were found, or why a
/// line cannot be opened. Ends soon after `interruption` was set.
Result<int, Failure> probe_modbus(const ProbePlan& plan, const ProbeProgress& progress, const ProbeFound& found,
                                  const bus::Interruption& interruption);

/// The line settings of a serial port that are worth trying, the likeliest first: those of the profiles, and then the
/// others that devices can be set to. `bauds` and `parities` narrow them; empty: all.
std::vector<bus::ModbusLine> likely_modbus_lines(const std::string& device,
                                                 const std::vector<NamedModbusProfile>& profiles,
                                                 const std::vector<int>& bauds, const std::vector<char>& parities);

/// Every profile that is shipped, in the order of their names. `directory` is searched first.
std::vector<NamedModbusProfile> shipped_modbus_profiles(const std::string& directory);

/// Returns the [[sensor]] table for a configuration, for a fit that has a speed. `name` is the sensor's; `device` is
/// the name of the serial port to write, if there is one.
std::string sensor_table_for(const std::string& name, const bus::ModbusLine& line, const Fit& fit,
                             const Profile& profile, const std::string& device);

}  // namespace yuragi::drivers::modbus
