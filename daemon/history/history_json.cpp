#include "daemon/history/history_json.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/base/json_text.hpp"

namespace yuragi::daemon::history {
namespace {

using nlohmann::ordered_json;

constexpr double kMinWind_m_s = 1e-6;  ///< below it a sum of vectors has no direction

/// To two digits: a week of 16 sensors is half a megabyte so.
double rounded(double value) {
  return std::round(100.0 * value) / 100.0;
}

ordered_json direction_of(const Step& step) {
  const wind::Vector sum = step.vector_sum_m_s;
  if (wind::speed_of(sum) < kMinWind_m_s) return nullptr;
  return std::fmod(std::round(wind::direction_from_deg(sum)), 360.0);
}

}  // namespace

std::string history_json(const WindHistory& history) {
  ordered_json content = {{"begin_s", history.begin_s},
                          {"step_s", history.step_s},
                          {"step_count", history.step_count},
                          {"files_left_out", history.files_left_out},
                          {"sensors", ordered_json::array()}};
  for (const SensorHistory& sensor : history.sensors) {
    ordered_json& row = content["sensors"].emplace_back();
    row["name"] = sensor.name;
    for (const Step& step : sensor.steps) {
      const bool is_gap = step.readings == 0;
      row["min_m_s"].push_back(is_gap ? ordered_json() : ordered_json(rounded(step.min_m_s)));
      row["mean_m_s"].push_back(is_gap ? ordered_json() : ordered_json(rounded(step.mean_m_s())));
      row["max_m_s"].push_back(is_gap ? ordered_json() : ordered_json(rounded(step.max_m_s)));
      row["direction_deg"].push_back(direction_of(step));
    }
  }
  return json_text(content) + "\n";
}

}  // namespace yuragi::daemon::history
