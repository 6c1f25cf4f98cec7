// A microcontroller that prints numbers: columns ("4.2,270,6.1") or keys ("speed=4.2 direction=270"), by its
// parameters. The formats: drivers/decode/text/line.hpp.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/decode/json_pointer.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/serial_or_tcp.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "drivers/text/byte_port_parameters.hpp"
#include "drivers/text/line_sensor.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::text {
namespace {

constexpr std::array<std::string_view, 4> kLineFormats = {"auto", "columns", "keys", "json"};
constexpr std::array<std::string_view, 4> kLineSeparators = {"comma", "semicolon", "tab", "blank"};
constexpr std::array<char, 4> kLineSeparatorBytes = {',', ';', '\t', ' '};

using decode::text::LineOptions;
using decode::text::LineQuantity;

char separator_named(const std::string& name) {
  return kLineSeparatorBytes.at(
      static_cast<std::size_t>(std::ranges::find(kLineSeparators, name) - kLineSeparators.begin()));
}

/// Columns are counted from 1 by people.
std::optional<std::size_t> column_of(std::int64_t number) {
  return number > 0 ? std::optional(static_cast<std::size_t>(number - 1)) : std::nullopt;
}

Result<std::optional<double>, Failure> invalid_number_of(const std::string& text) {
  if (text.empty()) return std::optional<double>();
  const auto number = decode::parse_number(text);
  if (!number || !*number) return Failure{"\"" + text + "\" is not a number; allowed: a number such as \"-999\""};
  return {boost::system::in_place_value, *number};
}

/// How a line is read. The gust has the speed's scale and unit.
const Fields<LineOptions> kLineReading = {
    {{.name = "format",
      .default_value = std::string("auto"),
      .help = "columns: 4.2,270; keys: speed=4.2 direction=NW, in one line or each in its own; json: {\"speed\": 4.2}; "
              "auto: json if the line begins "
              "with '{', keys if it has '=' or ':'",
      .choices = kLineFormats},
     &LineOptions::format},
    {{.name = "separator",
      .default_value = std::string("comma"),
      .help = "between columns; blank: any number of spaces and tabs",
      .choices = kLineSeparators},
     &LineOptions::separator,
     separator_named},
    {{"speed_column", "", std::int64_t{1}, 0, static_cast<double>(decode::kMaxTextFields),
      "number of the column, from 1; 0: none"},
     member_of(&LineOptions::speed, &LineQuantity::column),
     column_of},
    {{"direction_column", "", std::int64_t{2}, 0, static_cast<double>(decode::kMaxTextFields), "0: none"},
     member_of(&LineOptions::direction, &LineQuantity::column),
     column_of},
    {{"gust_column", "", std::int64_t{0}, 0, static_cast<double>(decode::kMaxTextFields), "0: none"},
     member_of(&LineOptions::gust, &LineQuantity::column),
     column_of},
    {{.name = "speed_key",
      .default_value = std::string("speed"),
      .help = "exact; json: or a pointer such as /wind/speed; empty: none"},
     member_of(&LineOptions::speed, &LineQuantity::key)},
    {{.name = "direction_key", .default_value = std::string("direction"), .help = "exact; empty: none"},
     member_of(&LineOptions::direction, &LineQuantity::key)},
    {{.name = "gust_key", .default_value = std::string("gust"), .help = "exact; empty: none"},
     member_of(&LineOptions::gust, &LineQuantity::key)},
    {{.name = "speed_unit",
      .default_value = std::string("m/s"),
      .help = "the unit of speed and gust, after scale and offset, if the line itself has none (speed: 15 km/h)",
      .choices = sensor::kSpeedUnitNames},
     member_of(&LineOptions::speed, &LineQuantity::unit),
     sensor::metres_per_second_in},
    {{.name = "speed_scale",
      .default_value = 1.0,
      .help = "factor on speed and gust (0.1 for tenths), before speed_offset is added"},
     member_of(&LineOptions::speed, &LineQuantity::scale)},
    {{.name = "speed_offset", .default_value = 0.0, .help = "added to speed and gust, in speed_unit"},
     member_of(&LineOptions::speed, &LineQuantity::offset)},
    {{.name = "direction_scale",
      .default_value = 1.0,
      .help = "factor that gives the direction in degrees (22.5 for points 0 to 15)"},
     member_of(&LineOptions::direction, &LineQuantity::scale)},
    {{.name = "invalid",
      .default_value = std::string(""),
      .help = "number that means \"no value\", such as \"-999\"; empty: none. nan and null always mean it"},
     &LineOptions::invalid,
     invalid_number_of},
};

const Fields<LineSensorSettings> kLineFields = {
    {{"north_offset", "deg", 0.0, -360.0, 360.0, "bearing of the vane's north mark, clockwise from north"},
     &LineSensorSettings::north_offset_deg},
    {{"hold", "s", 60.0, 0.1, 86400.0,
      "a direction or gust that came in another line is used for this long with speeds that come without one"},
     &LineSensorSettings::hold,
     from_seconds},
};
const std::vector<Parameter> kLineParameters =
    with_byte_port_parameters(together(kLineReading.parameters(), kLineFields.parameters()), 2.0);

/// A key that begins with a slash is a JSON pointer wherever lines may be JSON.
void check_key(std::string_view name, const std::string& key, decode::text::LineFormat format) {
  const bool may_be_json = format == decode::text::LineFormat::kJson || format == decode::text::LineFormat::kAuto;
  if (!may_be_json || !key.starts_with('/') || decode::is_json_pointer(key)) return;
  throw std::runtime_error(fmt::format(
      "{}: \"{}\" is not a JSON pointer, such as /wind/speed; write ~ in a name as ~0, and / as ~1", name, key));
}

}  // namespace

std::span<const Parameter> line_reading_parameters() {
  return kLineReading.parameters();
}

decode::text::LineOptions line_options_of(const ParameterValues& values) {
  LineOptions line = kLineReading.of(values);
  line.gust.scale = line.speed.scale;
  line.gust.offset = line.speed.offset;
  line.gust.unit = line.speed.unit;
  for (const auto& [name, key] :
       {std::pair("speed_key", &line.speed.key), std::pair("direction_key", &line.direction.key),
        std::pair("gust_key", &line.gust.key)})
    check_key(name, *key, line.format);
  if (!line.speed.column && line.speed.key.empty()) {
    throw std::runtime_error("speed_column: is missing, and so is speed_key; set one of them");
  }
  if (line.speed.column && (line.speed.column == line.direction.column || line.speed.column == line.gust.column)) {
    throw std::runtime_error("speed_column: another quantity has the same column");
  }
  return line;
}

LineSensorSettings line_sensor_settings_of(const ParameterValues& values) {
  LineSensorSettings settings = kLineFields.of(values);
  settings.text = text_sensor_settings_of(values);
  settings.text.ending = decode::text::LineEnding::kEtx;
  settings.line = line_options_of(values);

  // Only the end of the line before it proves that a line is complete from its beginning on.
  const bool flows = settings.text.address.kind == bus::BytePortKind::kSerial ||
                     settings.text.address.kind == bus::BytePortKind::kTcpClient;
  const bool is_polled = settings.text.poll_interval > Nanoseconds::zero();
  settings.text.doubts_first_line = flows && !is_polled;
  if (is_polled && settings.text.request.empty()) {
    throw std::runtime_error("request: is missing; poll_interval needs a request to send");
  }
  return settings;
}

namespace {

/// The place of the speed in a line; settings that the format does not use match any.
sensor::ValueSelection line_selection(const ParameterValues& values) {
  const LineSensorSettings settings = line_sensor_settings_of(values);
  const LineQuantity& speed = settings.line.speed;
  const bool is_columns = settings.line.format == decode::text::LineFormat::kColumns;
  const bool has_columns = is_columns || settings.line.format == decode::text::LineFormat::kAuto;
  return text_selection(
      settings.text,
      {{.key = "speed_column", .value = has_columns ? std::to_string(speed.column ? *speed.column + 1 : 0) : ""},
       {.key = "speed_key", .value = is_columns ? "" : speed.key}});
}

Result<sensor::SimulatedDevice, Failure> line_simulated(const ParameterValues& values) {
  const bool has_keys = values.text("format") == "keys";
  const std::int64_t direction_column = values.integer("direction_column");
  const std::string& direction_key = values.text("direction_key");
  const bool is_laid_out_so =
      has_keys ? values.text("speed_key") == "speed" && (direction_key.empty() || direction_key == "direction")
               : values.text("separator") == "comma" && values.integer("speed_column") == 1 &&
                     (direction_column == 0 || direction_column == 2) && values.integer("gust_column") == 0;
  const bool has_plain_numbers = values.text("speed_unit") == "m/s" && values.number("speed_scale") == 1.0 &&
                                 values.number("speed_offset") == 0.0 && values.number("direction_scale") == 1.0;
  if (!is_laid_out_so || !has_plain_numbers)
    return Failure{"yuragi-sim sends only lines of speed and direction in m/s and degrees, such as 4.2,270"};
  sensor::SimulatedDevice simulated =
      sensor::simulated_by_tcp("line", values, {"--format", has_keys ? "key-value" : "csv"});
  simulated.north_offset_deg = values.number("north_offset");
  return simulated;
}

}  // namespace

extern const sensor::DriverDescription kLineDriver;
const sensor::DriverDescription kLineDriver{
    .name = "line",
    .summary = "microcontrollers that print numbers, one reading per line",
    .parameters = kLineParameters,
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      const LineSensorSettings settings = line_sensor_settings_of(values);
      return std::make_unique<LineSensor>(settings, bus::make_byte_port(settings.text.address));
    },
    .find =
        [] {
          return sensor::find_behind_serial_ports("transport = \"serial\"\n",
                                                  "\nbaud = 9600  # as in Serial.begin() of the sketch");
        },
    .endpoints = byte_port_endpoints,
    .selection = line_selection,
    .simulated = line_simulated,
    .formats = "line"};

}  // namespace yuragi::drivers::text
