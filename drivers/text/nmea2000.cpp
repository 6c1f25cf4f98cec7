// Wind of an NMEA 2000 bus (PGN 130306): from a CAN interface of the kernel's, or as gateways and programs write it in
// lines: the RAW mode of Yacht Devices' gateways, N2K ASCII of Actisense's, canboat's plain lines, JSON of its
// analyzer, candump of can-utils. The formats are described with their decoders: drivers/decode/marine.
#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/bus/can_interfaces.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/text/byte_port_parameters.hpp"
#include "drivers/text/nmea2000_sensor.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::text {
namespace {

using decode::marine::AngleUnit;
using decode::marine::BusLineOptions;

constexpr std::array<std::string_view, 5> kNmea2000Transports = {"serial", "tcp", "udp", "file", "can"};
constexpr std::array<std::string_view, 3> kAngleUnits = {"auto", "deg", "rad"};
/// Of an identifier, the PGN of the wind; its priority and the sender's address do not matter.
constexpr bus::CanFilter kWindFrames = {.identifier = decode::marine::kWindDataPgn << 8U, .mask = 0x3FFFFU << 8U};

std::optional<std::uint8_t> address_of(std::int64_t number) {
  return number < 0 ? std::nullopt : std::optional(static_cast<std::uint8_t>(number));
}

std::optional<AngleUnit> angle_unit_of(const std::string& word) {
  if (word == "deg") return AngleUnit::kDegrees;
  return word == "rad" ? std::optional(AngleUnit::kRadians) : std::nullopt;
}

auto of_bus_lines(auto member) {
  return member_of(&Nmea2000SensorSettings::lines, member);
}

const Fields<Nmea2000SensorSettings> kNmea2000Fields = {
    {{.name = "format",
      .default_value = std::string("auto"),
      .help = "yacht-devices: RAW mode of YDWG-02, YDEN-02, YDNU-02; canboat: JSON of canboat's analyzer (n2kd) or "
              "canboatjs; candump: can-utils' lines; canboat-plain: lines of canboat's actisense-serial and of logs of "
              "Signal K servers; actisense: N2K ASCII of Actisense W2K-1 and others; auto: detected for each line",
      .choices = decode::marine::kBusLineFormatNames},
     of_bus_lines(&BusLineOptions::format)},
    {{"address", "", std::int64_t{-1}, -1, 255,
      "accept only the wind of the device with this address on the bus; -1: any"},
     &Nmea2000SensorSettings::address,
     address_of},
    {{.name = "angle_unit",
      .default_value = std::string("auto"),
      .help = "canboat: rad with analyzer -si and canboatjs, deg otherwise; auto: as in the analyzer's first line; "
              "without that line, deg after the first angle that cannot be in radians, and no direction before it",
      .choices = kAngleUnits},
     of_bus_lines(&BusLineOptions::angle_unit),
     angle_unit_of},
};

std::vector<Parameter> nmea2000_parameters() {
  std::vector<Parameter> own = together(kNmea2000Fields.parameters(), chosen_wind_parameters());
  own.push_back({.name = "interface",
                 .default_value = std::string("can0"),
                 .help = "can: the CAN interface, as ip link names it; it must be up, with the bus's bit rate (ip link "
                         "set can0 up type can bitrate 250000)"});
  std::vector<Parameter> all = with_byte_port_parameters(own, 0.0);
  const auto transport = std::ranges::find(all, "transport", &Parameter::name);
  transport->choices = kNmea2000Transports;
  transport->help =
      "can: a CAN interface of this machine; of a gateway, serial: a serial port; tcp: a server to connect "
      "to; udp: datagrams sent to this machine; file: a file or named pipe";
  return all;
}
const std::vector<Parameter> kNmea2000Parameters = nmea2000_parameters();

std::vector<sensor::FoundDevice> find_behind_can_interfaces() {
  std::vector<sensor::FoundDevice> found;
  for (const bus::CanInterfaceInfo& info : bus::find_can_interfaces()) {
    found.push_back({.what = "CAN interface " + info.name,
                     .settings = fmt::format("transport = \"can\"\ninterface = \"{}\"", info.name),
                     .trouble = info.trouble,
                     .remedy = info.remedy});
  }
  return found;
}

}  // namespace

Nmea2000SensorSettings nmea2000_sensor_settings_of(const ParameterValues& values) {
  Nmea2000SensorSettings settings = kNmea2000Fields.of(values);
  settings.text = text_sensor_settings_of(values);
  settings.text.longest_line = decode::marine::kMaxBusLine;
  settings.wind = chosen_wind_settings_of(values);
  if (settings.text.address.kind == bus::BytePortKind::kCan) {
    settings.lines.format = decode::marine::BusLineFormat::kCandump;
    settings.text.address.can = kWindFrames;
  }
  if (settings.text.poll_interval > Nanoseconds::zero())
    throw std::runtime_error("poll_interval: a gateway sends without requests; leave it out");
  return settings;
}

namespace {

/// The format for yuragi-sim, for a sensor's lines; for a CAN interface that of candump.
std::string simulated_format(const ParameterValues& values) {
  const std::string& format = values.text("format");
  if (values.text("transport") == "can") return "candump";
  if (format == "canboat" && values.text("angle_unit") == "rad") return "canboat-si";
  return format == "auto" ? "yacht-devices" : format;
}

Result<sensor::SimulatedDevice, Failure> nmea2000_simulated(const ParameterValues& values) {
  const std::string format = simulated_format(values);
  const std::string& wanted = values.text("reference");
  const bool is_from_north = wanted == "north";
  sensor::SimulatedDevice simulated = sensor::simulated_by_tcp("nmea2000", values,
                                                               {"--format", format, "--reference",
                                                                is_from_north      ? "north"
                                                                : wanted == "true" ? "boat"
                                                                                   : "apparent"});
  if (values.text("transport") == "can") simulated.values.set("format", format);
  simulated.values.set("address", std::int64_t{-1});  // the simulator's own, which is no fault of the configuration
  if (!is_from_north) simulated.north_offset_deg = values.number("north_offset");
  return simulated;
}

}  // namespace

extern const sensor::DriverDescription kNmea2000Driver;
const sensor::DriverDescription kNmea2000Driver{
    .name = "nmea2000",
    .summary =
        "wind of an NMEA 2000 bus: a CAN interface, gateways of Yacht Devices (RAW) and Actisense (N2K ASCII), "
        "canboat, candump",
    .parameters = kNmea2000Parameters,
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      const Nmea2000SensorSettings settings = nmea2000_sensor_settings_of(values);
      return std::make_unique<Nmea2000Sensor>(settings, bus::make_byte_port(settings.text.address));
    },
    .find = find_behind_can_interfaces,
    .endpoints = byte_port_endpoints,
    .selection =
        [](const ParameterValues& values) {
          const std::optional<std::uint8_t> address = kNmea2000Fields.of(values).address;
          return text_selection(text_sensor_settings_of(values),
                                {{.key = "address", .value = address ? std::to_string(*address) : ""},
                                 reference_part(chosen_wind_settings_of(values))});
        },
    .simulated = nmea2000_simulated,
    .formats = "nmea2000"};

}  // namespace yuragi::drivers::text
