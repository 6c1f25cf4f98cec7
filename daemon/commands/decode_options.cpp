#include "daemon/commands/decode_options.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "daemon/exit.hpp"
#include "engine/base/units.hpp"

namespace yuragi {
namespace {

/// An option whose words stand for values.
template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value,
                        const std::map<std::string, Value>& words, const std::string& help) {
  return command
      .add_option_function<std::string>(
          name, [&value, words](const std::string& word) { value = words.at(word); }, help)
      ->check(CLI::IsMember(words));
}

}  // namespace

void DecodeCommandOptions::add_to(CLI::App& command) {
  command.add_option("format", format, "how the messages are written; see below")->required()->option_text("FORMAT");
  command.add_option("file", file, "where they are; - or nothing: standard input")->option_text("[FILE|-]");
  command.add_flag(
      "--hex", is_hex,
      "a message a line, as hexadecimal digits (blanks, commas and 0x may stand between bytes; a line that "
      "begins with # is a comment)");
  command.add_flag("--refused", shows_refused, "tell of what is refused too, and why");
  add_policies(command);
  add_line_options(command);
  add_station_options(command);
  add_modbus_options(command);
  add_counter_options(command);
}

void DecodeCommandOptions::check() {
  const std::string name = format.substr(0, format.find(':'));
  for (const auto& [option, formats] : limited_) {
    const TextFields words = split_fields(formats, ',');
    const auto* const end = words.values.data() + words.count;
    const bool is_read = std::any_of(words.values.data(), end, [&](auto word) { return trimmed(word) == name; });
    if (option->count() > 0 && !is_read) {
      throw ExitError(kExitUsage,
                      fmt::format("{} means nothing to {}: it is for {}", option->get_name(), name, formats));
    }
  }
  set_line();
}

CLI::Option* DecodeCommandOptions::limit(CLI::Option* option, const std::string& formats) {
  option->group("Only for " + formats);
  limited_.push_back({option, formats});
  return option;
}

/// The driver's keys of the same names mean the same: what reads a log here reads the device there.
void DecodeCommandOptions::set_line() {
  if (speed_column_ != 0 && (speed_column_ == direction_column_ || speed_column_ == gust_column_)) {
    throw ExitError(kExitUsage, "--speed-column: another quantity stands in the same column");
  }
  const auto column_of = [](unsigned number) {
    return number > 0 ? std::optional<std::size_t>(number - 1) : std::nullopt;
  };
  LineOptions& line = decoder.line;
  line.speed.column = column_of(speed_column_);
  line.direction.column = column_of(direction_column_);
  line.gust.column = column_of(gust_column_);
  line.speed.scale *= metres_per_second_per_unit_;
  line.speed.offset *= metres_per_second_per_unit_;
  line.gust.scale = line.speed.scale;
  line.gust.offset = line.speed.offset;
}

void DecodeCommandOptions::add_policies(CLI::App& command) {
  const std::map<std::string, WhenMissing> missing = {{"refuse", WhenMissing::kRefuse},
                                                      {"accept", WhenMissing::kAccept}};
  const auto add_missing = [&](const char* name, WhenMissing& value, const char* help) {
    limit(add_choice(command, name, value, missing, help)->option_text("refuse|accept"), "nmea, gill, umb, ft");
  };
  add_missing("--checksum", decoder.checksum,
              "what to do where the checksum is missing (default refuse); a wrong one is always refused");
  add_missing("--status", decoder.status,
              "the same of the status (default refuse); accepted, the reading is uncertain");
  limit(command.add_option("--xdr-id", decoder.xdr_first_id, "the address of the WXT whose XDR is read (default 0)")
            ->check(CLI::Range(0, 255))
            ->option_text("N"),
        "nmea");
  limit(command.add_option("--node", decoder.node, "take only this one's messages")->option_text("A..Z"), "gill");
  limit(command.add_option("--device", decoder.umb_device, "take only this one's answers (28673 is WS no. 1)")
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
  LineOptions& line = decoder.line;
  const auto add = [&](const char* name, auto& value, const char* help, const char* type) {
    return limit(command.add_option(name, value, help)->option_text(type), "line");
  };
  const auto add_words = [&](const char* name, auto& value, const auto& words, const char* help, const char* type) {
    limit(add_choice(command, name, value, words, help)->option_text(type), "line");
  };
  const std::map<std::string, LineFormat> formats = {
      {"auto", LineFormat::kAuto}, {"columns", LineFormat::kColumns}, {"keys", LineFormat::kKeys}};
  const std::map<std::string, char> separators = {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"blank", ' '}};
  const std::map<std::string, double> units = {
      {"m/s", 1.0}, {"km/h", kMetresPerSecondPerKmh}, {"kn", kMetresPerSecondPerKnot}, {"mph", kMetresPerSecondPerMph}};
  add_words("--format", line.format, formats, "auto (the default): keys where the line has '=' or ':'",
            "auto|columns|keys");
  add_words("--separator", line.separator, separators,
            "between columns (default comma); blank: any number of blanks and tabs", "comma|semicolon|tab|blank");
  add("--speed-column", speed_column_, "the first column is 1, 0 is none (default 1)", "N");
  add("--direction-column", direction_column_, "the same (default 2)", "N");
  add("--gust-column", gust_column_, "the same (default 0)", "N");
  add("--speed-key", line.speed.key, "exact (default speed)", "KEY");
  add("--direction-key", line.direction.key, "exact (default direction)", "KEY");
  add("--gust-key", line.gust.key, "exact (default gust)", "KEY");
  add_words("--speed-unit", metres_per_second_per_unit_, units,
            "of speed and gust, after scale and offset (default m/s)", "m/s|km/h|kn|mph");
  add("--speed-scale", line.speed.scale, "speed and gust are the number times this (0.1 for tenths) plus the offset",
      "FACTOR");
  add("--speed-offset", line.speed.offset, "in the speed's unit (default 0)", "NUMBER");
  add("--direction-scale", line.direction.scale, "22.5 for points 0 to 15 (default 1)", "FACTOR");
  add("--invalid", line.invalid, "the number that means no value, -999 say", "NUMBER");
}

void DecodeCommandOptions::add_station_options(CLI::App& command) {
  limit(command.add_flag("--reports", decoder.are_reports,
                         "each line is an input report of 8 bytes as it came over USB (sensors watch --raw --hex)"),
        "wmr100, te923, fineoffset");
}

void DecodeCommandOptions::add_modbus_options(CLI::App& command) {
  const auto add = [&](const char* name, int& value, const char* help) {
    limit(command.add_option(name, value, help)->check(CLI::Range(1, 247))->option_text("ID"), "modbus");
  };
  add("--speed-slave", decoder.speed_slave, "the slave that measures speed, instead of the profile's");
  add("--direction-slave", decoder.direction_slave, "the same of the direction");
}

void DecodeCommandOptions::add_counter_options(CLI::App& command) {
  const auto add = [&](const char* name, auto& value, const char* help, const char* type) {
    return limit(command.add_option(name, value, help)->option_text(type), "mcc1208, labjack");
  };
  CLI::Option* slope = add("--slope", decoder.cup.metres_per_pulse,
                           "wind that passes between two pulses: m/s for each pulse a second", "METRES");
  CLI::Option* interval =
      add("--interval", decoder.interval_s, "from one reply to the next: with it, counts are a speed", "SECONDS");
  slope->check(CLI::PositiveNumber)->needs(interval);
  interval->check(CLI::PositiveNumber)->needs(slope);
  add("--offset", decoder.cup.offset_m_s, "the wind below which the cup stands (default 0)", "M/S")
      ->check(CLI::Range(0.0, 10.0))
      ->needs(slope);
  add("--vane-reference", decoder.vane_reference_v, "over the vane's track: with it, volts are a direction", "VOLTS")
      ->check(CLI::PositiveNumber);

  const std::map<std::string, LabjackInput> inputs = {{"low-voltage", LabjackInput::kLowVoltage},
                                                      {"high-voltage", LabjackInput::kHighVoltage}};
  limit(add_choice(command, "--input", decoder.input, inputs,
                   "low-voltage: 0 to 2.44 V (the default); high-voltage: AIN0 to AIN3 of a U3-HV")
            ->option_text("INPUT"),
        "labjack");
}

}  // namespace yuragi
