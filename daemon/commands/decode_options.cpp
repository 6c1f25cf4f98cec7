#include "daemon/commands/decode_options.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "daemon/commands/exit.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/text/line_sensor.hpp"
#include "drivers/text/nmea2000_sensor.hpp"
#include "drivers/text/nmea_sensor.hpp"

namespace yuragi::daemon::commands {
namespace {

/// An option that takes one of several names, each for a value.
template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value,
                        const std::map<std::string, Value>& words, const std::string& help) {
  return command
      .add_option_function<std::string>(
          name, [&value, words](const std::string& word) { value = words.at(word); }, help)
      ->check(CLI::IsMember(words));
}

/// A parameter's name as an option.
std::string option_of(std::string name) {
  std::ranges::replace(name, '_', '-');
  return "--" + name;
}

const Parameter& parameter_named(const drivers::sensor::DriverDescription& driver, std::string_view name) {
  return *std::ranges::find(driver.parameters, name, &Parameter::name);
}

/// A parameter of the driver `nmea` that is an option here.
struct TextOption {
  std::string_view parameter;
  std::string_view option;
  std::string_view formats;
};
constexpr std::array<TextOption, 4> kTextOptions = {{{"missing_checksum", "--checksum", "nmea, gill, umb, ft, wxt"},
                                                     {"missing_status", "--status", "nmea, gill, umb, ft"},
                                                     {"xdr_id", "--xdr-id", "nmea"},
                                                     {"speed_range", "--speed-range", "umb"}}};

}  // namespace

void DecodeCommandOptions::add_to(CLI::App& command) {
  // Not "format": CLI11 2.4 refuses a positional with the name of an option, here that of --format.
  command.add_option("message_format", format, "the format of the messages; see below")
      ->required()
      ->option_text("FORMAT");
  command.add_option("file", file, "the file; - or nothing: standard input")->option_text("[FILE|-]");
  command.add_flag("--hex", is_hex,
                   "one message per line, as hexadecimal digits (blanks, commas and 0x are allowed between bytes; a "
                   "line that begins with # is a comment)");
  command.add_flag("--refused", shows_refused, "also print what is refused, and why");
  add_text_options(command);
  add_line_options(command);
  add_marine_options(command);
  add_station_options(command);
  add_modbus_options(command);
  add_counter_options(command);
}

void DecodeCommandOptions::check() {
  const std::string name = format.substr(0, format.find(':'));
  for (const auto& [option, formats] : limited_) {
    const drivers::decode::TextFields words = drivers::decode::split_fields(formats, ',');
    const auto* const end = words.values.data() + words.count;
    const bool is_read =
        std::any_of(words.values.data(), end, [&](auto word) { return drivers::decode::trimmed(word) == name; });
    if (option->count() > 0 && !is_read) {
      throw ExitError(kExitUsage,
                      fmt::format("{} does not apply to {}; it is for {}", option->get_name(), name, formats));
    }
  }
  set_text();
  set_line();
  set_marine();
}

CLI::Option* DecodeCommandOptions::limit(CLI::Option* option, const std::string& formats) {
  option->group("Only for " + formats);
  limited_.push_back({option, formats});
  return option;
}

/// The driver's own parameters, checked and read by the driver, as for a sensor that reads a file: missing ones have
/// the driver's defaults.
void DecodeCommandOptions::set_text() {
  ParameterValues::Map given = given_for_text_;
  given["transport"] = std::string("file");
  given["file"] = std::string("-");
  const auto values = ParameterValues::resolve(drivers::sensor::find_driver("nmea")->parameters, given);
  if (!values) {
    const auto* const option = std::ranges::find(kTextOptions, values.error().name, &TextOption::parameter);
    const std::string name = option == kTextOptions.end() ? values.error().name : std::string(option->option);
    throw ExitError(kExitUsage, fmt::format("{}: {}", name, values.error().message));
  }
  const drivers::text::NmeaSensorSettings settings = drivers::text::nmea_sensor_settings_of(*values);
  decoder.checksum = settings.checksum;
  decoder.makers_checksum = settings.makers_checksum;
  decoder.status = settings.status;
  decoder.xdr_first_id = settings.xdr_first_id;
  decoder.umb_speed_range_m_s = settings.speed_range_m_s;
}

/// The driver's own parameters, checked by the driver: logs are decoded with the settings of the device.
void DecodeCommandOptions::set_line() {
  const auto values = ParameterValues::resolve(drivers::text::line_reading_parameters(), given_for_line_);
  if (!values) {
    throw ExitError(kExitUsage, fmt::format("{}: {}", option_of(values.error().name), values.error().message));
  }
  try {
    decoder.line = drivers::text::line_options_of(*values);
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    const std::size_t colon = std::min(text.find(':'), text.size());
    throw ExitError(kExitUsage, option_of(text.substr(0, colon)) + text.substr(colon));
  }
}

/// The driver's own parameters, as of a sensor that reads a file.
void DecodeCommandOptions::set_marine() {
  ParameterValues::Map given = given_for_marine_;
  given["transport"] = std::string("file");
  given["file"] = std::string("-");
  const auto values = ParameterValues::resolve(drivers::sensor::find_driver("nmea2000")->parameters, given);
  if (!values) {
    throw ExitError(kExitUsage, fmt::format("{}: {}", option_of(values.error().name), values.error().message));
  }
  decoder.bus_lines = drivers::text::nmea2000_sensor_settings_of(*values).lines;
}

/// A driver's parameter as an option.
void DecodeCommandOptions::add_parameter(CLI::App& command, const Parameter& parameter, const std::string& option,
                                         ParameterValues::Map& given, const std::string& formats) {
  const std::string help = fmt::format("{} ({})", parameter.help, describe_allowed(parameter));
  std::visit(
      [&](const auto& default_value) {
        using Value = std::decay_t<decltype(default_value)>;
        const auto take = [&given, name = std::string(parameter.name)](const Value& value) { given[name] = value; };
        const char* type = std::is_same_v<Value, std::string> ? "TEXT" : "NUMBER";
        limit(command.add_option_function<Value>(option, take, help)->option_text(type), formats);
      },
      printable(parameter.default_value));
}

void DecodeCommandOptions::add_text_options(CLI::App& command) {
  for (const TextOption& each : kTextOptions) {
    add_parameter(command, parameter_named(*drivers::sensor::find_driver("nmea"), each.parameter),
                  std::string(each.option), given_for_text_, std::string(each.formats));
  }
  limit(command.add_option("--node", decoder.node, "accept only the messages of this one")->option_text("A..Z"),
        "gill");
  limit(command.add_option("--device", decoder.umb_device, "accept only the replies of this one (28673 is WS no. 1)")
            ->option_text("N"),
        "umb, umb-binary");
}

void DecodeCommandOptions::add_line_options(CLI::App& command) {
  for (const Parameter& parameter : drivers::text::line_reading_parameters()) {
    add_parameter(command, parameter, option_of(std::string(parameter.name)), given_for_line_, "line");
  }
}

void DecodeCommandOptions::add_marine_options(CLI::App& command) {
  add_parameter(command, parameter_named(*drivers::sensor::find_driver("nmea2000"), "angle_unit"), "--angle-unit",
                given_for_marine_, "nmea2000");
}

void DecodeCommandOptions::add_station_options(CLI::App& command) {
  limit(command.add_flag("--reports", decoder.are_reports,
                         "each line is an input report of 8 bytes as received over USB (sensors watch --raw --hex)"),
        "wmr100, te923, fineoffset");
}

void DecodeCommandOptions::add_modbus_options(CLI::App& command) {
  const auto add = [&](const char* name, int& value, const char* help) {
    limit(command.add_option(name, value, help)->check(CLI::Range(1, 247))->option_text("ID"), "modbus");
  };
  add("--speed-slave", decoder.speed_slave, "the slave that measures the speed, instead of the profile's");
  add("--direction-slave", decoder.direction_slave, "the slave that measures the direction, instead of the profile's");
}

void DecodeCommandOptions::add_counter_options(CLI::App& command) {
  const auto add = [&](const char* name, auto& value, const std::string& help, const char* type) {
    return limit(command.add_option(name, value, help)->option_text(type), "mcc1208, labjack");
  };
  add("--interval", decoder.interval_s, "time between replies; with it, counts give a speed", "SECONDS")
      ->check(CLI::PositiveNumber);

  // The cup's and the vane's, with the driver's limits and defaults.
  const auto of_driver = [](std::string_view name) -> const Parameter& {
    return parameter_named(*drivers::sensor::find_driver("usb"), name);
  };
  const auto add_cup = [&](const char* name, double& value, const Parameter& parameter, const char* type) {
    value = std::get<double>(parameter.default_value);
    add(name, value, fmt::format("{} ({})", parameter.help, describe_allowed(parameter)), type)
        ->check(CLI::Range(parameter.min, parameter.max))
        ->needs("--interval");
  };
  add_cup("--slope", decoder.cup.metres_per_pulse, of_driver("metres_per_pulse"), "METRES");
  add_cup("--offset", decoder.cup.offset_m_s, of_driver("offset"), "M/S");
  const Parameter& reference = of_driver("reference_voltage");
  add("--vane-reference", decoder.vane_reference_v,
      fmt::format("voltage over the vane's potentiometer ({}); only with it do volts give a direction",
                  describe_allowed(reference)),
      "VOLTS")
      ->check(CLI::Range(reference.min, reference.max));

  const std::map<std::string, drivers::decode::usb::LabjackInput> inputs = {
      {"low-voltage", drivers::decode::usb::LabjackInput::kLowVoltage},
      {"high-voltage", drivers::decode::usb::LabjackInput::kHighVoltage}};
  limit(add_choice(command, "--input", decoder.input, inputs,
                   "low-voltage: 0 to 2.44 V (the default); high-voltage: AIN0 to AIN3 of a U3-HV")
            ->option_text("INPUT"),
        "labjack");
}

}  // namespace yuragi::daemon::commands
