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

namespace yuragi::drivers::text {
namespace {

constexpr std::array<std::string_view, 4> kLineFormats = {"auto", "columns", "keys", "json"};
constexpr std::array<std::string_view, 4> kLineSeparators = {"comma", "semicolon", "tab", "blank"};
constexpr std::array<char, 4> kLineSeparatorBytes = {',', ';', '\t', ' '};

/// How a line is read.
const std::array kLineReading = {
    Parameter{
        .name = "format",
        .unit = "",
        .default_value = std::string("auto"),
        .help =
            "columns: 4.2,270; keys: speed=4.2 direction=270; json: {\"speed\": 4.2}; auto: json where the line begins "
            "with '{', keys where it has '=' or ':'",
        .choices = kLineFormats},
    Parameter{.name = "separator",
              .unit = "",
              .default_value = std::string("comma"),
              .help = "between columns; blank: any number of spaces and tabs",
              .choices = kLineSeparators},
    Parameter{.name = "speed_column",
              .unit = "",
              .default_value = std::int64_t{1},
              .min = 0,
              .max = static_cast<double>(decode::kMaxTextFields),
              .help = "number of the column, from 1; 0: none"},
    Parameter{.name = "direction_column",
              .unit = "",
              .default_value = std::int64_t{2},
              .min = 0,
              .max = static_cast<double>(decode::kMaxTextFields),
              .help = "0: none"},
    Parameter{.name = "gust_column",
              .unit = "",
              .default_value = std::int64_t{0},
              .min = 0,
              .max = static_cast<double>(decode::kMaxTextFields),
              .help = "0: none"},
    Parameter{.name = "speed_key",
              .unit = "",
              .default_value = std::string("speed"),
              .help = "exact; json: or a pointer such as /wind/speed; empty: none"},
    Parameter{
        .name = "direction_key", .unit = "", .default_value = std::string("direction"), .help = "exact; empty: none"},
    Parameter{.name = "gust_key", .unit = "", .default_value = std::string("gust"), .help = "exact; empty: none"},
    Parameter{.name = "speed_unit",
              .unit = "",
              .default_value = std::string("m/s"),
              .help = "of speed and gust, after scale and offset, where the line itself says none (speed: 15 km/h)",
              .choices = sensor::kSpeedUnitNames},
    Parameter{.name = "speed_scale",
              .unit = "",
              .default_value = 1.0,
              .help = "factor on speed and gust (0.1 for tenths), before speed_offset is added"},
    Parameter{
        .name = "speed_offset", .unit = "", .default_value = 0.0, .help = "added to speed and gust, in speed_unit"},
    Parameter{.name = "direction_scale",
              .unit = "",
              .default_value = 1.0,
              .help = "factor that gives the direction in degrees (22.5 for points 0 to 15)"},
    Parameter{.name = "invalid",
              .unit = "",
              .default_value = std::string(""),
              .help = "number that means \"no value\", such as \"-999\"; empty: none. nan and null always mean it"},
};

std::vector<Parameter> line_driver_parameters() {
  std::vector<Parameter> own(kLineReading.begin(), kLineReading.end());
  own.push_back({.name = "north_offset",
                 .unit = "deg",
                 .default_value = 0.0,
                 .min = -360.0,
                 .max = 360.0,
                 .help = "bearing of the vane's north mark, clockwise from north"});
  return with_byte_port_parameters(std::move(own), 2.0);
}
const std::vector<Parameter> kLineParameters = line_driver_parameters();

/// Columns are counted from 1 by people.
std::optional<std::size_t> column_of(std::int64_t number) {
  return number > 0 ? std::optional(static_cast<std::size_t>(number - 1)) : std::nullopt;
}

std::optional<double> invalid_number_of(const std::string& text) {
  if (text.empty()) return {};
  const auto number = decode::parse_number(text);
  if (!number || !*number)
    throw std::runtime_error("invalid: \"" + text + "\" is not a number; allowed: a number such as \"-999\"");
  return *number;
}

/// A key that begins with a slash is a JSON pointer wherever lines may be JSON.
void check_key(std::string_view name, const std::string& key, decode::text::LineFormat format) {
  const bool may_be_json = format == decode::text::LineFormat::kJson || format == decode::text::LineFormat::kAuto;
  if (!may_be_json || !key.starts_with('/') || decode::is_json_pointer(key)) return;
  throw std::runtime_error(fmt::format(
      "{}: \"{}\" is not a JSON pointer, in which ~ is written ~0 and a slash of a name ~1, as in /wind/speed", name,
      key));
}

}  // namespace

std::span<const Parameter> line_reading_parameters() {
  return kLineReading;
}

decode::text::LineOptions line_options_of(const ParameterValues& values) {
  decode::text::LineOptions line;
  line.format = static_cast<decode::text::LineFormat>(std::ranges::find(kLineFormats, values.text("format")) -
                                                      kLineFormats.begin());
  const auto separator = std::ranges::find(kLineSeparators, values.text("separator")) - kLineSeparators.begin();
  line.separator = kLineSeparatorBytes[static_cast<std::size_t>(separator)];
  line.invalid = invalid_number_of(values.text("invalid"));

  const double m_s_per_unit = sensor::metres_per_second_in(values.text("speed_unit"));
  line.speed = {.column = column_of(values.integer("speed_column")),
                .key = values.text("speed_key"),
                .scale = values.number("speed_scale"),
                .offset = values.number("speed_offset"),
                .unit = m_s_per_unit};
  line.gust = line.speed;
  line.gust.column = column_of(values.integer("gust_column"));
  line.gust.key = values.text("gust_key");
  line.direction = {.column = column_of(values.integer("direction_column")),
                    .key = values.text("direction_key"),
                    .scale = values.number("direction_scale")};
  for (const auto& [name, key] :
       {std::pair("speed_key", &line.speed.key), std::pair("direction_key", &line.direction.key),
        std::pair("gust_key", &line.gust.key)})
    check_key(name, *key, line.format);
  if (!line.speed.column && line.speed.key.empty()) {
    throw std::runtime_error("speed_column: neither it nor speed_key is set; a sensor needs a speed");
  }
  if (line.speed.column && (line.speed.column == line.direction.column || line.speed.column == line.gust.column)) {
    throw std::runtime_error("speed_column: another quantity has the same column");
  }
  return line;
}

LineSensorSettings line_sensor_settings_of(const ParameterValues& values) {
  LineSensorSettings settings;
  settings.text = text_sensor_settings_of(values);
  settings.text.ending = decode::text::LineEnding::kEtx;
  settings.line = line_options_of(values);
  settings.north_offset_deg = values.number("north_offset");

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

/// Where the speed stands in a line; what the format does not use is any.
sensor::ValueSelection line_selection(const ParameterValues& values) {
  const std::string& format = values.text("format");
  const bool has_columns = format == "auto" || format == "columns";
  return text_selection(
      line_sensor_settings_of(values).text,
      {{.key = "speed_column", .value = has_columns ? std::to_string(values.integer("speed_column")) : ""},
       {.key = "speed_key", .value = format == "columns" ? "" : values.text("speed_key")}});
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
                                                  "\nbaud = 9600  # as Serial.begin() of the sketch says");
        },
    .claims = byte_port_claims,
    .selection = line_selection};

}  // namespace yuragi::drivers::text
