#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "daemon/tools/decode/decode_formats.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::daemon::commands {

/// The options of `yuragi decode`.
class DecodeCommandOptions {
 public:
  std::string format;
  std::string file = "-";
  bool is_hex = false;
  bool shows_refused = false;
  tools::decode::UnitDecoderOptions decoder;

  /// Adds them to the command; this object must outlive it.
  void add_to(CLI::App& command);

  /// Call it after parsing. Throws ExitError if an option does not apply to the format, or if two quantities
  /// have the same column.
  void check();

 private:
  /// Options that only some formats have.
  struct Limited {
    CLI::Option* option;
    std::string formats;  ///< their names, separated by ", "
  };

  CLI::Option* limit(CLI::Option* option, const std::string& formats);
  void add_parameter(CLI::App& command, const Parameter& parameter, const std::string& option,
                     ParameterValues::Map& given, const std::string& formats);
  void add_text_options(CLI::App& command);
  void add_line_options(CLI::App& command);
  void add_marine_options(CLI::App& command);
  void add_station_options(CLI::App& command);
  void add_modbus_options(CLI::App& command);
  void add_counter_options(CLI::App& command);
  void set_text();
  void set_line();
  void set_marine();

  ParameterValues::Map given_for_text_;
  ParameterValues::Map given_for_line_;
  ParameterValues::Map given_for_marine_;
  std::vector<Limited> limited_;
};

}  // namespace yuragi::daemon::commands
