#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "daemon/tools/decode/decode_formats.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi {

/// What `yuragi decode` can be told.
class DecodeCommandOptions {
 public:
  std::string format;
  std::string file = "-";
  bool is_hex = false;
  bool shows_refused = false;
  UnitDecoderOptions decoder;

  /// Adds all of them to the command, which this object must outlive.
  void add_to(CLI::App& command);

  /// To be called once the command line has been read. Throws ExitError where an option was given that means nothing
  /// to the format, or where two quantities stand in one column.
  void check();

 private:
  /// Options that only some formats read.
  struct Limited {
    CLI::Option* option;
    std::string formats;  ///< their names, with ", " between
  };

  CLI::Option* limit(CLI::Option* option, const std::string& formats);
  void add_policies(CLI::App& command);
  void add_line_options(CLI::App& command);
  void add_station_options(CLI::App& command);
  void add_modbus_options(CLI::App& command);
  void add_counter_options(CLI::App& command);
  void set_line();

  ParameterValues::Map given_for_line_;
  std::vector<Limited> limited_;
};

}  // namespace yuragi
