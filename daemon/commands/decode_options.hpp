#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "daemon/decode_formats.hpp"

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

  unsigned speed_column_ = 1;
  unsigned direction_column_ = 2;
  unsigned gust_column_ = 0;
  double metres_per_second_per_unit_ = 1.0;
  std::vector<Limited> limited_;
};

}  // namespace yuragi
