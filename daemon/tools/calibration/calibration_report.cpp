#include "daemon/tools/calibration/calibration_report.hpp"

#include <algorithm>
#include <utility>

#include "daemon/settings/page_file.hpp"
#include "daemon/settings/standard_output.hpp"
#include "daemon/tools/calibration/calibration_ways.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::daemon::tools::calibration {
namespace {

using nlohmann::ordered_json;

ordered_json json_of(const ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return nullptr;
}

ordered_json json_of(std::span<const settings::ConfigChange> values) {
  ordered_json json = ordered_json::object();
  for (const settings::ConfigChange& one : values) json[settings::page_key_of(one)] = json_of(one.value);
  return json;
}

template <class Value>
ordered_json or_null(const std::optional<Value>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

}  // namespace

Report::Report(std::vector<const settings::SensorConfig*> sensors, double duration_s)
    : sensors_(std::move(sensors)),
      duration_s_(duration_s),
      state_({{"sensor", sensors_.front()->name},
              {"duration_s", duration_s},
              {"elapsed_s", nullptr},
              {"readings", ordered_json::array()},
              {"notes", ordered_json::array()},
              {"points", ordered_json::array()},
              {"before", nullptr},
              {"after", nullptr},
              {"effect", nullptr}}) {}

void Report::progress(double elapsed_s, const CollectedReadings& so_far) {
  if (elapsed_s < next_line_s_ && elapsed_s < duration_s_) return;
  next_line_s_ = elapsed_s + std::max(1.0, duration_s_ / kMaxProgressLines);
  state_["elapsed_s"] = std::min(elapsed_s, duration_s_);
  state_["readings"] = ordered_json::array();
  for (std::size_t index = 0; index < so_far.size(); ++index) {
    ordered_json one = {{"sensor", sensors_[index]->name},
                        {"count", so_far[index].readings.size()},
                        {"speed_m_s", nullptr},
                        {"direction_deg", nullptr}};
    if (!so_far[index].readings.empty()) {
      const wind::Reading& last = so_far[index].readings.back().reading;
      one["speed_m_s"] = last.speed_m_s * sensors_[index]->calibration.unit_m_s;
      one["direction_deg"] = or_null(last.direction_deg);
    }
    state_["readings"].push_back(std::move(one));
  }
  print();
}

void Report::note(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return;
  state_["notes"].push_back(text.substr(begin, text.find_last_not_of(' ') - begin + 1));
  print();
}

void Report::point(const wind::judging::CalibrationPoint& point) {
  state_["points"].push_back({{"measured_m_s", point.measured_m_s}, {"true_m_s", point.true_m_s}});
  print();
}

void Report::found(std::span<const settings::ConfigChange> before, std::span<const settings::ConfigChange> after,
                   const Effect& effect) {
  state_["before"] = json_of(before);
  state_["after"] = json_of(after);
  ordered_json rows = ordered_json::array();
  for (const Effect::Row& row : effect.rows)
    rows.push_back({{"indicated", row.indicated}, {"now", row.now}, {"then", row.then}});
  state_["effect"] = {{"indicated_unit", effect.indicated_unit}, {"unit", effect.unit}, {"rows", std::move(rows)}};
  print();
}

void Report::print() const {
  settings::write_at_once(json_text(state_) + "\n");
}

ordered_json calibrations_json(const settings::Config& config) {
  ordered_json all = ordered_json::array();
  for (const settings::SensorConfig& sensor : config.sensors) {
    const bool is_configured = !sensor.origin.empty() && !sensor.driver->plays_recordings;
    ordered_json possible = ordered_json::array();
    for (const Way& way : ways()) {
      if (!is_configured || way.means != sensor.driver->calibration) continue;
      possible.push_back({{"calibration", way.calibration},
                          {"given", name_of(way.given)},
                          {"duration_s", way.duration_s},
                          {"preparation", way.preparation}});
    }
    ordered_json now = ordered_json::object();
    for (const Parameter& key : settings::page_calibration_keys(*sensor.driver))
      now[key.name] = json_of(settings::value_at(sensor, settings::place_of_page_key(key.name)));
    all.push_back({{"sensor", sensor.name},
                   {"driver", sensor.driver->name},
                   {"now", std::move(now)},
                   {"ways", std::move(possible)}});
  }
  return all;
}

}  // namespace yuragi::daemon::tools::calibration
