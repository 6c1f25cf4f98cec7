// Wind sensors with Modbus, over TCP or a serial line (RTU). Which registers hold what is data: one TOML file a
// device in drivers/modbus/profiles, which names its source. Functions 3 and 4, big-endian 16-bit registers on the wire
// (MODBUS Application Protocol Specification V1.1b3).
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "drivers/bus/byte_port.hpp"
#include "drivers/bus/serial_ports.hpp"
#include "drivers/modbus/modbus_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/serial_or_tcp.hpp"

namespace yuragi::drivers::modbus {
namespace {

constexpr std::array<std::string_view, 2> kTransports = {"tcp", "rtu"};
constexpr std::array<std::string_view, 4> kParityChoices = {"profile", "none", "even", "odd"};

const std::array kModbusParameters = {
    Parameter{.name = "profile",
              .unit = "",
              .default_value = std::string("renke-rs-fsjt-rs-fxjt-n01"),
              .help = "the device's register map: a name in drivers/modbus/profiles, or the path of a .toml file"},
    Parameter{.name = "profile_dir",
              .unit = "",
              .default_value = std::string(""),
              .help = "a directory that is searched for profiles first"},
    Parameter{.name = "transport",
              .unit = "",
              .default_value = std::string("tcp"),
              .help = "tcp: a device or gateway in the network; rtu: a serial port",
              .choices = kTransports},
    Parameter{.name = "host", .unit = "", .default_value = std::string("127.0.0.1"), .help = "tcp: name or address"},
    Parameter{
        .name = "port", .unit = "", .default_value = std::int64_t{502}, .min = 1, .max = 65535, .help = "tcp: port"},
    Parameter{.name = "device",
              .unit = "",
              .default_value = std::string(""),
              .help = "rtu: the serial port, preferably by its stable name in /dev/serial/by-id"},
    Parameter{.name = "direction_device",
              .unit = "",
              .default_value = std::string(""),
              .help = "rtu: the serial port of the vane, where it is on a separate line"},
    Parameter{.name = "baud",
              .unit = "bit/s",
              .default_value = std::int64_t{0},
              .min = 0,
              .max = 115200,
              .help = "rtu: 0 takes the profile's"},
    Parameter{.name = "parity",
              .unit = "",
              .default_value = std::string("profile"),
              .help = "rtu: \"profile\" takes the profile's",
              .choices = kParityChoices},
    Parameter{.name = "stop_bits",
              .unit = "",
              .default_value = std::int64_t{0},
              .min = 0,
              .max = 2,
              .help = "rtu: 0 takes the profile's"},
    Parameter{.name = "speed_slave",
              .unit = "",
              .default_value = std::int64_t{0},
              .min = 0,
              .max = 247,
              .help = "id of the slave that measures speed, and the other quantities that the profile has on it; 0 "
                      "takes the profile's"},
    Parameter{.name = "direction_slave",
              .unit = "",
              .default_value = std::int64_t{0},
              .min = 0,
              .max = 247,
              .help = "id of the slave that measures direction; 0 takes the profile's"},
    Parameter{.name = "poll_interval",
              .unit = "s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 3600.0,
              .help = "interval between readings; 0 takes the profile's"},
    Parameter{.name = "min_gap",
              .unit = "s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 10.0,
              .help = "least time from a reply to the next request on this line, for adapters that switch direction "
                      "slowly; 0 takes "
                      "the profile's"},
    Parameter{.name = "response_timeout",
              .unit = "s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 10.0,
              .help = "longest wait for a reply, and for a connection; 0 takes the profile's"},
};

/// The profile with the settings of the installation.
ModbusProfile profile_of(const ParameterValues& values) {
  ModbusProfile profile = load_modbus_profile(values.text("profile"), values.text("profile_dir"));
  if (const std::int64_t baud = values.integer("baud"); baud != 0) profile.baud = static_cast<int>(baud);
  if (const std::string& parity = values.text("parity"); parity == "none") {
    profile.parity = 'N';
  } else if (parity == "even") {
    profile.parity = 'E';
  } else if (parity == "odd") {
    profile.parity = 'O';
  }
  if (const std::int64_t bits = values.integer("stop_bits"); bits != 0) profile.stop_bits = static_cast<int>(bits);
  if (const std::int64_t slave = values.integer("speed_slave"); slave != 0) {
    set_slave(profile, static_cast<std::uint8_t>(slave));
  }
  if (const std::int64_t slave = values.integer("direction_slave"); slave != 0) {
    if (!profile.direction)
      throw std::runtime_error("direction_slave: profile \"" + profile.name + "\" has no direction");
    profile.direction->slave = static_cast<std::uint8_t>(slave);
  }
  if (const double interval_s = values.number("poll_interval"); interval_s > 0.0) {
    profile.poll_interval = from_seconds(interval_s);
  }
  if (const double gap_s = values.number("min_gap"); gap_s > 0.0) profile.min_gap = from_seconds(gap_s);
  if (const double timeout_s = values.number("response_timeout"); timeout_s > 0.0) {
    profile.response_timeout = from_seconds(timeout_s);
  }
  return profile;
}

bus::ModbusLine line_of(const ParameterValues& values, const ModbusProfile& profile) {
  bus::ModbusLine line;
  line.framing =
      values.text("transport") == "tcp" ? decode::modbus::ModbusFraming::kTcp : decode::modbus::ModbusFraming::kRtu;
  line.host = values.text("host");
  line.port = static_cast<std::uint16_t>(values.integer("port"));
  line.device = values.text("device");
  line.baud = profile.baud;
  line.parity = profile.parity;
  line.stop_bits = profile.stop_bits;
  line.connect_timeout = std::max(profile.response_timeout, line.connect_timeout);

  if (line.framing == decode::modbus::ModbusFraming::kTcp) {
    if (line.host.empty())
      throw std::runtime_error("host: is empty; give the name or address of the device or gateway");
    return line;
  }
  if (line.device.empty()) {
    throw std::runtime_error("device: is missing; transport rtu needs a serial port, such as /dev/ttyUSB0");
  }
  if (std::ranges::find(kModbusBauds, line.baud) == kModbusBauds.end()) {
    throw std::runtime_error("baud: is " + std::to_string(line.baud) +
                             "; allowed: 0, 1200, 2400, 4800, 9600, 19200, 38400, 57600 or 115200");
  }
  if (!profile.is_serial) {
    throw std::runtime_error("transport: profile \"" + profile.name + "\" has no serial port; use tcp");
  }
  return line;
}

/// The separate line of the vane; nullptr where it has none.
std::shared_ptr<ModbusBus> direction_bus_of(const ParameterValues& values, const ModbusProfile& profile,
                                            const bus::ModbusLine& line) {
  const std::string& device = values.text("direction_device");
  if (device.empty()) return nullptr;
  if (line.framing != decode::modbus::ModbusFraming::kRtu) {
    throw std::runtime_error("direction_device: is for transport rtu; over tcp both slaves are behind one host");
  }
  if (!profile.direction) {
    throw std::runtime_error("direction_device: profile \"" + profile.name + "\" has no direction");
  }
  bus::ModbusLine own = line;
  own.device = device;
  return shared_modbus_bus(own);
}

std::unique_ptr<sensor::Sensor> open_modbus(const ParameterValues& values) {
  ModbusProfile profile = profile_of(values);
  const bus::ModbusLine line = line_of(values, profile);
  const std::uint32_t seed = sensor::seed_of(describe(line) + profile.name + std::to_string(profile.speed.slave));
  const auto direction_bus = direction_bus_of(values, profile, line);
  return std::make_unique<ModbusSensor>(std::move(profile), shared_modbus_bus(line), direction_bus, seed);
}

/// Sensors on one line share it (ModbusBus); devices and gateways in a network have no line.
std::vector<sensor::DeviceClaim> modbus_claims(const ParameterValues& values) {
  std::vector<sensor::DeviceClaim> claims;
  if (values.text("transport") == "tcp") return claims;
  for (const std::string_view key : {"device", "direction_device"}) {
    const std::string& device = values.text(key);
    if (!device.empty()) claims.push_back({.device = bus::serial_device_of(device), .is_shared = true});
  }
  return claims;
}

/// The register that holds the speed: sensors may have a vane in common.
sensor::ValueSelection modbus_selection(const ParameterValues& values) {
  const ModbusProfile profile = profile_of(values);
  const bool is_tcp = values.text("transport") == "tcp";
  return {.device = is_tcp
                        ? "Modbus line " + bus::device_of({.kind = bus::BytePortKind::kTcpClient,
                                                           .host = values.text("host"),
                                                           .port = static_cast<std::uint16_t>(values.integer("port"))})
                        : bus::serial_device_of(values.text("device")),
          .device_keys = is_tcp ? "host, port" : "device",
          .parts = {{.key = "speed_slave", .value = std::to_string(profile.speed.slave)},
                    {.key = "profile",
                     .value = fmt::format("function {}, register {}", profile.speed.function, profile.speed.address)}}};
}

/// Every profile that can be found by name. One that cannot be read says why.
std::vector<sensor::KnownDevice> known_modbus_devices() {
  std::vector<sensor::KnownDevice> devices;
  for (const std::string& name : modbus_profile_names("")) {
    try {
      const ModbusProfile profile = load_modbus_profile(name, "");
      sensor::KnownDevice device = {
          .name = name, .device = profile.name, .unconfirmed = profile.unconfirmed, .value = profile.value};
      for (const ProfileEvidence evidence : profile.confirmed_by) {
        device.confirmed_by.push_back(kProfileEvidenceNames.at(static_cast<std::size_t>(evidence)));
      }
      devices.push_back(std::move(device));
    } catch (const std::runtime_error& error) {
      devices.push_back({.name = name, .device = "a profile that cannot be read", .unconfirmed = error.what()});
    }
  }
  return devices;
}

/// Any serial port may have a Modbus line behind it: `yuragi sensors probe modbus` finds out.
std::vector<sensor::FoundDevice> find_modbus() {
  return sensor::find_behind_serial_ports("transport = \"rtu\"\n");
}

/// What the profile states.
std::optional<sensor::StatedValue> modbus_value(const ParameterValues& values) {
  try {
    return profile_of(values).value;
  } catch (const std::runtime_error&) {
    return std::nullopt;  // open() fails and gives the reason
  }
}

sensor::PromisedQuantities modbus_promises(const ParameterValues& values) {
  const ModbusProfile profile = profile_of(values);
  return {.direction = profile.direction.has_value(), .gust = profile.gust.has_value()};
}

}  // namespace

extern const sensor::DriverDescription kModbusDriver;
const sensor::DriverDescription kModbusDriver{
    .name = "modbus",
    .summary = "anemometers and vanes on Modbus TCP or RTU, by device profiles",
    .parameters = kModbusParameters,
    .open = open_modbus,
    .find = find_modbus,
    .claims = modbus_claims,
    .selection = modbus_selection,
    .known_devices = known_modbus_devices,
    .promises = modbus_promises,
    .stated_value = modbus_value};

}  // namespace yuragi::drivers::modbus
