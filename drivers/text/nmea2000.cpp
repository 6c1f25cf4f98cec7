// Wind of an NMEA 2000 bus (PGN 130306), as gateways and programs write it in lines: the RAW mode of Yacht Devices'
// gateways, and JSON of canboat's analyzer. The formats are described with their decoders: drivers/decode/marine.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/text/byte_port_parameters.hpp"
#include "drivers/text/nmea2000_sensor.hpp"

namespace yuragi::drivers::text {
namespace {

constexpr std::array<std::string_view, 3> kNmea2000Formats = {"auto", "yacht-devices", "canboat"};
constexpr std::array<std::string_view, 3> kAngleUnits = {"auto", "deg", "rad"};
/// canboat's longest records have some thousand bytes.
constexpr std::size_t kLongestRecord = 8192;

std::vector<Parameter> nmea2000_parameters() {
  std::vector<Parameter> own = {
      {.name = "format",
       .unit = "",
       .default_value = std::string("auto"),
       .help = "yacht-devices: RAW mode of YDWG-02, YDEN-02, YDNU-02; canboat: JSON of canboat's analyzer (n2kd) or "
               "canboatjs; auto: detected for each line",
       .choices = kNmea2000Formats},
      {.name = "address",
       .unit = "",
       .default_value = std::int64_t{-1},
       .min = -1,
       .max = 255,
       .help = "accept only the wind of the device with this address on the bus; -1: any"},
      {.name = "angle_unit",
       .unit = "",
       .default_value = std::string("auto"),
       .help =
           "canboat: rad with analyzer -si and canboatjs, deg otherwise; auto: as the analyzer's first line says, or "
           "degrees once an angle comes that cannot be in radians; until then there is no direction",
       .choices = kAngleUnits},
  };
  std::ranges::move(chosen_wind_parameters(), std::back_inserter(own));
  return with_byte_port_parameters(std::move(own), 0.0);
}
const std::vector<Parameter> kNmea2000Parameters = nmea2000_parameters();

}  // namespace

Nmea2000SensorSettings nmea2000_sensor_settings_of(const ParameterValues& values) {
  Nmea2000SensorSettings settings;
  settings.text = text_sensor_settings_of(values);
  settings.text.longest_line = kLongestRecord;
  settings.format = static_cast<Nmea2000Format>(std::ranges::find(kNmea2000Formats, values.text("format")) -
                                                kNmea2000Formats.begin());
  if (const std::int64_t address = values.integer("address"); address >= 0)
    settings.address = static_cast<std::uint8_t>(address);
  const std::string& unit = values.text("angle_unit");
  if (unit == "deg") settings.angle_unit = decode::marine::AngleUnit::kDegrees;
  if (unit == "rad") settings.angle_unit = decode::marine::AngleUnit::kRadians;
  settings.wind = chosen_wind_settings_of(values);
  if (settings.text.poll_interval > Nanoseconds::zero())
    throw std::runtime_error("poll_interval: a gateway sends without requests; leave it out");
  return settings;
}

extern const sensor::DriverDescription kNmea2000Driver;
const sensor::DriverDescription kNmea2000Driver{
    .name = "nmea2000",
    .summary = "wind of an NMEA 2000 bus: Yacht Devices' gateways in RAW mode, canboat",
    .parameters = kNmea2000Parameters,
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      const Nmea2000SensorSettings settings = nmea2000_sensor_settings_of(values);
      return std::make_unique<Nmea2000Sensor>(settings, bus::make_byte_port(settings.text.address));
    },
    .find = nullptr,
    .claims = byte_port_claims};

}  // namespace yuragi::drivers::text
