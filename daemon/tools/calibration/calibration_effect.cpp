#include "daemon/tools/calibration/calibration_effect.hpp"

#include <fmt/format.h>

namespace yuragi::daemon::tools::calibration {
namespace {

std::string cell(double value, std::string_view unit) {
  return fmt::format("{:.{}f} {}", value, unit == "m/s" ? 2 : 1, unit);
}

}  // namespace

std::vector<std::string> lines_of(const Effect& effect) {
  const std::string_view quantity = effect.unit == "deg" ? "direction" : "speed";
  const auto line = [](const std::string& indicated, const std::string& now, const std::string& then) {
    return fmt::format("{:>12}  {:>15}  {:>15}", indicated, now, then);
  };
  std::vector<std::string> lines = {line(effect.indicated_unit == "dB" ? "level" : "reading",
                                         fmt::format("{} now", quantity), fmt::format("{} then", quantity))};
  for (const Effect::Row& row : effect.rows) {
    lines.push_back(
        line(cell(row.indicated, effect.indicated_unit), cell(row.now, effect.unit), cell(row.then, effect.unit)));
  }
  return lines;
}

}  // namespace yuragi::daemon::tools::calibration
