// Wind sensors with Modbus, over TCP or a serial line (RTU). Which registers hold what is data: one TOML file a
// device in drivers/modbus/profiles, which names its source. Functions 3 and 4, big-endian 16-bit registers on the wire
// (MODBUS Application Protocol Specification V1.1b3).
#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "drivers/bus/byte_port.hpp"
#include "drivers/bus/serial_ports.hpp"
#include "drivers/modbus/modbus_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/serial_or_tcp.hpp"
#include "engine/base/address.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::modbus {
namespace {

/// In the order of decode::modbus::Framing.
constexpr std::array<std::string_view, 2> kTransports = {"tcp", "rtu"};
constexpr std::array<std::string_view, 4> kParityChoices = {"profile", "none", "even", "odd"};

/// kModbusFields defines each; 0 and empty times are the profile's.
struct Keys {
  std::string profile;
  std::string profile_dir;
  decode::modbus::Framing framing = decode::modbus::Framing::kTcp;
  std::string host;
  std::uint16_t port = 0;
  std::string device;
  std::string direction_device;
  int baud = 0;
  char parity = 0;
  int stop_bits = 0;
  std::uint8_t speed_slave = 0;
  std::uint8_t direction_slave = 0;
  Nanoseconds poll_interval{};
  Nanoseconds min_gap{};
  Nanoseconds response_timeout{};
};

/// 0: the profile's.
char letter_of_parity(const std::string& word) {
  return word == "none" ? 'N' : word == "even" ? 'E' : word == "odd" ? 'O' : '\0';
}

const Fields<Keys> kModbusFields = {
    {{.name = "profile",
      .default_value = std::string("renke-rs-fsjt-rs-fxjt-n01"),
      .help = "the device's register map: a name in drivers/modbus/profiles, or the path of a .toml file"},
     &Keys::profile},
    {{.name = "profile_dir",
      .default_value = std::string(""),
      .help = "a directory that is searched for profiles first"},
     &Keys::profile_dir},
    {{.name = "transport",
      .default_value = std::string("tcp"),
      .help = "tcp: a device or gateway in the network; rtu: a serial port",
      .choices = kTransports},
     &Keys::framing},
    {{.name = "host", .default_value = std::string("127.0.0.1"), .help = "tcp: name or address"}, &Keys::host},
    {{"port", "", std::int64_t{502}, 1, 65535, "tcp: port"}, &Keys::port},
    {{.name = "device",
      .default_value = std::string(""),
      .help = "rtu: the serial port, preferably by its stable name in /dev/serial/by-id"},
     &Keys::device},
    {{.name = "direction_device",
      .default_value = std::string(""),
      .help = "rtu: the serial port of the vane, if it is on a separate line"},
     &Keys::direction_device},
    {{"baud", "bit/s", std::int64_t{0}, 0, 115200, "rtu: 0: the profile's"}, &Keys::baud},
    {{.name = "parity",
      .default_value = std::string("profile"),
      .help = "rtu: \"profile\": the profile's",
      .choices = kParityChoices},
     &Keys::parity,
     letter_of_parity},
    {{"stop_bits", "", std::int64_t{0}, 0, 2, "rtu: 0: the profile's"}, &Keys::stop_bits},
    {{"speed_slave", "", std::int64_t{0}, 0, 247,
      "id of the slave that measures speed, and the other quantities that the profile reads from it; 0: the profile's"},
     &Keys::speed_slave},
    {{"direction_slave", "", std::int64_t{0}, 0, 247, "id of the slave that measures direction; 0: the profile's"},
     &Keys::direction_slave},
    {{"poll_interval", "s", 0.0, 0.0, 3600.0, "interval between readings; 0: the profile's"},
     &Keys::poll_interval,
     from_seconds},
    {{"min_gap", "s", 0.0, 0.0, 10.0,
      "minimum time from a reply to the next request on this line, for adapters that switch direction slowly; 0: the "
      "profile's"},
     &Keys::min_gap,
     from_seconds},
    {{"response_timeout", "s", 0.0, 0.0, 10.0, "maximum wait for a reply, and for a connection; 0: the profile's"},
     &Keys::response_timeout,
     from_seconds},
};

/// The profile with the settings of the installation.
Profile profile_of(const Keys& keys) {
  Profile profile = load_modbus_profile(keys.profile, keys.profile_dir);
  if (keys.baud != 0) profile.baud = keys.baud;
  if (keys.parity != 0) profile.parity = keys.parity;
  if (keys.stop_bits != 0) profile.stop_bits = keys.stop_bits;
  if (keys.speed_slave != 0) set_slave(profile, keys.speed_slave);
  if (keys.direction_slave != 0) {
    if (!profile.direction)
      throw std::runtime_error("direction_slave: profile \"" + profile.name + "\" has no direction");
    profile.direction->slave = keys.direction_slave;
  }
  if (keys.poll_interval > Nanoseconds::zero()) profile.poll_interval = keys.poll_interval;
  if (keys.min_gap > Nanoseconds::zero()) profile.min_gap = keys.min_gap;
  if (keys.response_timeout > Nanoseconds::zero()) profile.response_timeout = keys.response_timeout;
  return profile;
}

bus::ModbusLine line_of(const Keys& keys, const Profile& profile) {
  bus::ModbusLine line{.framing = keys.framing,
                       .host = keys.host,
                       .port = keys.port,
                       .device = keys.device,
                       .baud = profile.baud,
                       .parity = profile.parity,
                       .stop_bits = profile.stop_bits};
  line.connect_timeout = std::max(profile.response_timeout, line.connect_timeout);

  if (line.framing == decode::modbus::Framing::kTcp) {
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

/// Returns the separate line of the vane; nullptr if it has none.
std::shared_ptr<Bus> direction_bus_of(const Keys& keys, const Profile& profile, const bus::ModbusLine& line) {
  if (keys.direction_device.empty()) return nullptr;
  if (line.framing != decode::modbus::Framing::kRtu) {
    throw std::runtime_error("direction_device: is only for transport rtu; with tcp both slaves have the same host");
  }
  if (!profile.direction) {
    throw std::runtime_error("direction_device: profile \"" + profile.name + "\" has no direction");
  }
  bus::ModbusLine own = line;
  own.device = keys.direction_device;
  return shared_modbus_bus(own);
}

std::unique_ptr<sensor::Sensor> open_modbus(const ParameterValues& values) {
  const Keys keys = kModbusFields.of(values);
  Profile profile = profile_of(keys);
  const bus::ModbusLine line = line_of(keys, profile);
  const std::uint32_t seed = sensor::seed_of(describe(line) + profile.name + std::to_string(profile.speed.slave));
  const auto direction_bus = direction_bus_of(keys, profile, line);
  return std::make_unique<Sensor>(std::move(profile), shared_modbus_bus(line), direction_bus, seed);
}

/// Sensors on one line share it (Bus); devices and gateways in a network have no line.
std::vector<sensor::Endpoint> modbus_endpoints(const ParameterValues& values) {
  const Keys keys = kModbusFields.of(values);
  if (keys.framing == decode::modbus::Framing::kTcp)
    return {{.kind = sensor::EndpointKind::kServer, .name = to_string(Address{keys.host, keys.port})}};
  std::vector<sensor::Endpoint> lines;
  for (const std::string& device : {keys.device, keys.direction_device}) {
    if (device.empty() && !lines.empty()) continue;
    lines.push_back({.kind = sensor::EndpointKind::kSerialPort,
                     .name = device,
                     .claim = device.empty() ? std::string() : bus::serial_device_of(device),
                     .is_shared = true});
  }
  return lines;
}

/// The register of the speed: sensors can share a vane.
sensor::ValueSelection modbus_selection(const ParameterValues& values) {
  const Keys keys = kModbusFields.of(values);
  const Profile profile = profile_of(keys);
  const bool is_tcp = keys.framing == decode::modbus::Framing::kTcp;
  return {.device =
              is_tcp ? "Modbus line " +
                           bus::device_of({.kind = bus::BytePortKind::kTcpClient, .host = keys.host, .port = keys.port})
                     : bus::serial_device_of(keys.device),
          .device_keys = is_tcp ? "host, port" : "device",
          .parts = {{.key = "speed_slave", .value = std::to_string(profile.speed.slave)},
                    {.key = "profile",
                     .value = fmt::format("function {}, register {}", profile.speed.function, profile.speed.address)}}};
}

/// Returns every profile that can be found by name; for one that cannot be read, the reason.
std::vector<sensor::KnownDevice> known_modbus_devices() {
  std::vector<sensor::KnownDevice> devices;
  for (const std::string& name : modbus_profile_names("")) {
    try {
      const Profile profile = load_modbus_profile(name, "");
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

/// Any serial port can have a Modbus line: `yuragi sensors probe modbus` searches it.
std::vector<sensor::FoundDevice> find_modbus() {
  return sensor::find_behind_serial_ports("transport = \"rtu\"\n");
}

/// What the profile states.
std::optional<sensor::StatedValue> modbus_value(const ParameterValues& values) {
  try {
    return profile_of(kModbusFields.of(values)).value;
  } catch (const std::runtime_error&) {
    return std::nullopt;  // open() fails and gives the reason
  }
}

sensor::PromisedQuantities modbus_promises(const ParameterValues& values) {
  const Profile profile = profile_of(kModbusFields.of(values));
  return {.direction = profile.direction.has_value(), .gust = profile.gust.has_value()};
}

/// yuragi-sim plays one line.
Result<sensor::SimulatedDevice, Failure> modbus_simulated(const ParameterValues& values) {
  const Keys keys = kModbusFields.of(values);
  if (!keys.direction_device.empty()) return Failure{"yuragi-sim simulates only one line: leave out direction_device"};
  if (keys.direction_slave != 0 && keys.direction_slave != keys.speed_slave &&
      keys.direction_slave != keys.speed_slave + 1)
    return Failure{"yuragi-sim simulates only a direction_slave that equals speed_slave, or is the next id"};
  if (keys.direction_slave != 0 && keys.speed_slave == 0)
    return Failure{"yuragi-sim simulates a direction_slave only if speed_slave is set, too"};
  std::string device = std::filesystem::path(keys.profile).stem().string();
  if (keys.speed_slave != 0) device += fmt::format("@{}", keys.speed_slave);
  sensor::SimulatedDevice simulated = sensor::simulated_by_tcp("modbus", values, {"--profile", device});
  simulated.values.set("direction_device", std::string());
  return simulated;
}

}  // namespace

extern const sensor::DriverDescription kModbusDriver;
const sensor::DriverDescription kModbusDriver{
    .name = "modbus",
    .summary = "anemometers and vanes on Modbus TCP or RTU, described by device profiles",
    .parameters = kModbusFields.parameters(),
    .open = open_modbus,
    .find = find_modbus,
    .endpoints = modbus_endpoints,
    .selection = modbus_selection,
    .known_devices = known_modbus_devices,
    .promises = modbus_promises,
    .stated_value = modbus_value,
    .simulated = modbus_simulated,
    .formats = "modbus:PROFILE"};

}  // namespace yuragi::drivers::modbus
