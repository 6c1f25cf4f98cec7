#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace yuragi::daemon::tools::calibration {

/// The effect of a calibration on a few readings.
struct Effect {
  struct Row {
    double indicated = 0.0;  ///< what the sensor reads
    double now = 0.0;        ///< what that means with the present calibration
    double then = 0.0;       ///< and with the new one
  };

  std::string_view indicated_unit;  ///< "m/s", "deg", or "dB" of a sound
  std::string_view unit;            ///< of the other two
  std::vector<Row> rows = {};
};

/// As the lines of a table. Pure.
std::vector<std::string> lines_of(const Effect& effect);

}  // namespace yuragi::daemon::tools::calibration
