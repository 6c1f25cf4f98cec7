#include "daemon/web/calibration_order.hpp"

#include <fmt/format.h>

namespace yuragi::daemon::web {

std::vector<std::string> words_of(const CalibrationOrder& order, const std::string& sensor) {
  std::vector<std::string> words = {order.calibration, "--json", "--sensor=" + sensor};
  // Archive has refused a sensor whose settings are not those that the daemon has it open with.
  if (order.calibration == "microphone") words.emplace_back("--unchanged");
  if (order.duration_s) words.push_back(fmt::format("--for={}", *order.duration_s));
  if (order.bearing_deg) words.push_back(fmt::format("--bearing={}", *order.bearing_deg));
  if (order.speed_m_s) words.push_back(fmt::format("--speed={}", *order.speed_m_s));
  if (!order.reference.empty()) words.push_back("--reference=" + order.reference);
  if (!order.points.empty()) {
    std::string points;
    for (const wind::judging::CalibrationPoint& point : order.points)
      points += fmt::format("{}{}:{}", points.empty() ? "" : " ", point.measured_m_s, point.true_m_s);
    words.push_back("--points=" + points);
  }
  return words;
}

}  // namespace yuragi::daemon::web
