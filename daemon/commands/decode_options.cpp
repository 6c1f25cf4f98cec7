#include "daemon/commands/decode_options.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "daemon/commands/exit.hpp"
#include "drivers/text/line_sensor.hpp"

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

}  // namespace

void DecodeCommandOptions::add_to(CLI::App& command) {
  command.add_option("format", format, "the format of the messages; see below")->required()->option_text("FORMAT");
  command.add_option("file", file, "the file; - or nothing: standard input")->option_text("[FILE|-]");
  command.add_flag("--hex", is_hex,
                   "one message per line, as hexadecimal digits (blanks, commas and 0x are allowed between bytes; a "
                   "line that begins with # is a comment)");
  command.add_flag("--refused", shows_refused, "also print what is refused, and why");
  add_policies(command);
  add_line_options(command);
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
  set_line();
}

CLI::Option* DecodeCommandOptions::limit(CLI::Option* option, const std::string& formats) {
  option->group("Only for " + formats);
  limited_.push_back({option, formats});
  return option;
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

void DecodeCommandOptions::add_policies(CLI::App& command) {
  const std::map<std::string, drivers::decode::WhenMissing> missing = {
      {"refuse", drivers::decode::WhenMissing::kRefuse}, {"accept", drivers::decode::WhenMissing::kAccept}};
  const auto add_missing = [&](const char* name, drivers::decode::WhenMissing& value, const char* help) {
    limit(add_choice(command, name, value, missing, help)->option_text("refuse|accept"), "nmea, gill, umb, ft");
  };
  add_missing("--checksum", decoder.checksum,
              "if the checksum is missing (default refuse); a wrong one is always refused");
  add_missing("--status", decoder.status,
              "if the status is missing (default refuse); an accepted reading is uncertain");
  limit(command.add_option("--xdr-id", decoder.xdr_first_id, "the address of the WXT whose XDR is read (default 0)")
            ->check(CLI::Range(0, 255))
            ->option_text("N"),
        "nmea");
  limit(command.add_option("--node", decoder.node, "accept only the messages of this one")->option_text("A..Z"),
        "gill");
  limit(command.add_option("--device", decoder.umb_device, "accept only the replies of this one (28673 is WS no. 1)")
            ->option_text("N"),
        "umb");
  limit(command
            .add_option("--speed-range", decoder.umb_speed_range_m_s,
                        "in ASCII mode: the speed that 65520 stands for (default 75; a VENTUS has 90)")
            ->check(CLI::PositiveNumber)
            ->option_text("M/S"),
        "umb");
}

void DecodeCommandOptions::add_line_options(CLI::App& command) {
  for (const Parameter& parameter : drivers::text::line_reading_parameters()) {
    const std::string name(parameter.name);
    const std::string help = fmt::format("{} ({})", parameter.help, describe_allowed(parameter));
    std::visit(
        [&](const auto& default_value) {
          using Value = std::decay_t<decltype(default_value)>;
          const auto take = [this, name](const Value& value) { given_for_line_[name] = value; };
          const char* type = std::is_same_v<Value, std::string> ? "TEXT" : "NUMBER";
          limit(command.add_option_function<Value>(option_of(name), take, help)->option_text(type), "line");
        },
        printable(parameter.default_value));
  }
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
  const auto add = [&](const char* name, auto& value, const char* help, const char* type) {
    return limit(command.add_option(name, value, help)->option_text(type), "mcc1208, labjack");
  };
  CLI::Option* slope =
      add("--slope", decoder.cup.metres_per_pulse, "speed per pulse rate: m/s for each pulse per second", "METRES");
  CLI::Option* interval =
      add("--interval", decoder.interval_s, "time between replies; with it, counts give a speed", "SECONDS");
  slope->check(CLI::PositiveNumber)->needs(interval);
  interval->check(CLI::PositiveNumber)->needs(slope);
  add("--offset", decoder.cup.offset_m_s, "the wind speed below which the cup does not turn (default 0)", "M/S")
      ->check(CLI::Range(0.0, 10.0))
      ->needs(slope);
  add("--vane-reference", decoder.vane_reference_v,
      "voltage over the vane's potentiometer; with it, volts give a direction", "VOLTS")
      ->check(CLI::PositiveNumber);

  const std::map<std::string, drivers::decode::usb::LabjackInput> inputs = {
      {"low-voltage", drivers::decode::usb::LabjackInput::kLowVoltage},
      {"high-voltage", drivers::decode::usb::LabjackInput::kHighVoltage}};
  limit(add_choice(command, "--input", decoder.input, inputs,
                   "low-voltage: 0 to 2.44 V (the default); high-voltage: AIN0 to AIN3 of a U3-HV")
            ->option_text("INPUT"),
        "labjack");
}

}  // namespace yuragi::daemon::commands
