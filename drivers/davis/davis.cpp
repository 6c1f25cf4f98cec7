// The console of a Davis Vantage Pro, Vantage Pro2 or Vantage Vue, by its data logger: WeatherLink for RS-232 or USB
// (which is a serial port), WeatherLinkIP (TCP, port 22222), or a serial port that a server in the network has. Its
// dialogue: Davis, "Vantage Pro, Vantage Pro2 and Vantage Vue Serial Communication Reference Manual" 2.6.1, chapters V,
// VII and VIII; drivers/SOURCES.md S10.1.
//
//   request                 reply                         for
//   LF                      LF CR                         waking it, and ending its packets; up to 3 times, 1.2 s apart
//   "EEBRD 2B 01" LF        ACK, a byte, its checksum     its rain collector
//   "LPS 2 n" LF            ACK, n packets LOOP2          one each 2 to 2.5 s
//   "LOOP n" LF             ACK, n packets LOOP           the same, of consoles with firmware before 1.90
#include <array>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/davis/vantage_sensor.hpp"
#include "drivers/decode/davis/vantage.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/serial_or_tcp.hpp"
#include "engine/base/fields.hpp"
#include "engine/base/units.hpp"

namespace yuragi::drivers::davis {
namespace {

using bus::BytePortAddress;

constexpr std::array kDavisBauds = {1200, 2400, 4800, 9600, 19200};
/// In the order of BytePortKind.
constexpr std::array<std::string_view, 2> kDavisTransports = {"serial", "tcp"};
constexpr std::array<std::string_view, 3> kDavisPackets = {"auto", "loop", "loop2"};

auto of(auto member) {
  return member_of(&VantageSettings::address, member);
}

const Fields<VantageSettings> kDavisFields = {
    {{.name = "transport",
      .default_value = std::string("serial"),
      .help = "serial: the logger's serial port or USB; tcp: a WeatherLinkIP, or a serial device server in the network",
      .choices = kDavisTransports},
     of(&BytePortAddress::kind)},
    {{.name = "device",
      .default_value = std::string(""),
      .help = "serial: the port, preferably by its stable name in /dev/serial/by-id"},
     of(&BytePortAddress::path)},
    {{"baud", "bit/s", std::int64_t{19200}, kDavisBauds.front(), kDavisBauds.back(),
      "serial: as set in the console; 8 data bits, no parity, 1 stop bit"},
     of(&BytePortAddress::baud)},
    {{.name = "host",
      .default_value = std::string(""),
      .help = "tcp: name or address; one program at a time can be connected to a WeatherLinkIP"},
     of(&BytePortAddress::host)},
    {{"port", "", std::int64_t{22222}, 1, 65535, "tcp: a WeatherLinkIP has 22222"}, of(&BytePortAddress::port)},
    {{.name = "packets",
      .default_value = std::string("auto"),
      .help = "loop2: with the strongest gust of 10 minutes; loop: without, for firmware before 1.90; auto: loop2, or "
              "loop if the console does not support it. Speeds are whole miles per hour",
      .choices = kDavisPackets},
     &VantageSettings::packets},
};

}  // namespace

VantageSettings vantage_settings_of(const ParameterValues& values) {
  VantageSettings settings = kDavisFields.of(values);
  sensor::check_serial_or_tcp(settings.address, kDavisBauds);
  return settings;
}

namespace {

std::unique_ptr<sensor::Sensor> open_davis(const ParameterValues& values) {
  const VantageSettings settings = vantage_settings_of(values);
  return std::make_unique<VantageSensor>(settings, bus::make_byte_port(settings.address));
}

Result<sensor::SimulatedDevice, Failure> davis_simulated(const ParameterValues& values) {
  sensor::SimulatedDevice simulated = sensor::simulated_by_tcp("davis", values);
  simulated.speed_step_m_s = kMetresPerSecondPerMph;  // it reports whole miles per hour
  return simulated;
}

constexpr std::array kDavisFormats = {
    sensor::MessageFormat{.name = "davis",
                          .unit = "a packet LOOP or LOOP2, of 99 bytes",
                          .devices = "consoles of Davis Vantage Pro, Vantage Pro2, Vantage Vue",
                          .example = "davis --hex packets.hex",
                          .decode = decode::davis::decode_vantage_packet}};

}  // namespace

extern const sensor::DriverDescription kDavisDriver;
const sensor::DriverDescription kDavisDriver{
    .name = "davis",
    .summary = "Davis Vantage Pro, Vantage Pro2 and Vantage Vue, through the data logger of their console",
    .parameters = kDavisFields.parameters(),
    .open = open_davis,
    .find = [] { return sensor::find_behind_serial_ports(); },
    .endpoints = [](const ParameterValues& values) { return sensor::endpoints_at(kDavisFields.of(values).address); },
    .selection =
        [](const ParameterValues& values) { return sensor::selection_at(vantage_settings_of(values).address); },
    .simulated = davis_simulated,
    .message_formats = kDavisFormats};

}  // namespace yuragi::drivers::davis
