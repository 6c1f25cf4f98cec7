#include "daemon/tools/report/report_json.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <optional>

#include <date/date.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/report/default_wind.hpp"
#include "daemon/tools/report/report_text.hpp"
#include "engine/base/compass.hpp"
#include "engine/base/json_text.hpp"
#include "engine/base/version.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::tools::report {
namespace {

using nlohmann::ordered_json;

/// An optional number, or null.
ordered_json json_of(const std::optional<double>& number) {
  return number ? ordered_json(*number) : ordered_json(nullptr);
}

std::string iso_text(UtcTime moment) {
  return date::format("%FT%TZ", std::chrono::floor<std::chrono::milliseconds>(moment));
}

ordered_json json_of_states(const SensorNumbers& sensor) {
  ordered_json totals = ordered_json::object();
  for (std::size_t i = 0; i < kRecordedStates; ++i) {
    const StateTotal& total = sensor.states[i];
    totals[std::string(kRecordedStateNames[i])] = {
        {"count", total.count}, {"time_s", total.time_s}, {"longest_s", total.longest_s}};
  }
  return totals;
}

ordered_json json_of_events(const RecordingNumbers& recording, const SensorNumbers& sensor) {
  ordered_json events = ordered_json::array();
  for (const StateEvent& event : sensor.events) {
    events.push_back({{"state", kRecordedStateNames[static_cast<std::size_t>(event.state)]},
                      {"from_s", event.from_s},
                      {"to_s", event.to_s},
                      {"length_s", event.length_s()},
                      {"from_utc", iso_text(recording.utc_at(event.from_s))},
                      {"to_utc", iso_text(recording.utc_at(event.to_s))}});
  }
  return events;
}

ordered_json json_of_spectrum(const SpectrumNumbers& spectrum) {
  ordered_json frequencies = ordered_json::array();
  for (std::size_t k = 0; k < spectrum.density_m2_s2_hz.size(); ++k) frequencies.push_back(spectrum.frequency_hz(k));
  ordered_json octaves = ordered_json::array();
  for (const OctaveBand& band : spectrum.octaves) {
    octaves.push_back({{"from_hz", band.from_hz},
                       {"to_hz", band.to_hz},
                       {"variance_m2_s2", band.variance_m2_s2},
                       {"fitted_m2_s2", json_of(band.fitted_m2_s2)},
                       {"is_in_fit", band.is_in_fit}});
  }
  ordered_json json = {{"component", spectrum.is_of_speed ? "speed" : "along the mean wind"},
                       {"segment_readings", spectrum.segment_readings},
                       {"segments", spectrum.segments},
                       {"step_s", spectrum.step_s},
                       {"octaves", octaves},
                       {"power_law", nullptr},
                       {"von_karman", nullptr},
                       {"frequency_hz", frequencies},
                       {"density_m2_s2_hz", spectrum.density_m2_s2_hz}};
  if (const auto& fit = spectrum.power_law) {
    json["power_law"] = {{"beta", fit->beta}, {"from_hz", fit->from_hz}, {"to_hz", fit->to_hz}};
  }
  if (const auto& fit = spectrum.von_karman) {
    json["von_karman"] = {{"speed_m_s", fit->speed_m_s},
                          {"turbulence_intensity", fit->intensity},
                          {"length_m", json_of(fit->length_m)},
                          {"time_scale_s", fit->time_scale_s},
                          {"rms_db", fit->rms_db},
                          {"from_hz", fit->from_hz},
                          {"to_hz", fit->to_hz}};
  }
  return json;
}

ordered_json json_of_site(const std::optional<SiteNumbers>& site) {
  if (!site) return nullptr;
  return {{"length_m", site->length_m}, {"known_s", site->known_s}, {"octaves_db", site->octaves_db}};
}

ordered_json json_of_default_wind(const std::optional<DefaultWind>& wind) {
  if (!wind) return nullptr;
  return {{"speed_m_s", wind->speed_m_s},
          {"direction_deg", json_of(wind->direction_deg)},
          {"turbulence_intensity", wind->turbulence_intensity},
          {"length_m", wind->length_m},
          {"is_length_measured", wind->is_length_measured}};
}

ordered_json json_of_series(const RecordingNumbers& recording, const SensorNumbers& sensor) {
  ordered_json rows = ordered_json::array();
  for (const TimeBin& bin : sensor.bins) {
    if (bin.count == 0) continue;
    const wind::Vector sum{bin.u_sum_m_s, bin.v_sum_m_s};
    std::optional<double> direction_deg;
    if (bin.directed > 0 && speed_of(sum) > 0.0) direction_deg = wind::direction_from_deg(sum);
    rows.push_back({{"time_s", bin.time_s()},
                    {"utc", iso_text(recording.utc_at(bin.time_s()))},
                    {"readings", bin.count},
                    {"min_m_s", bin.min_m_s},
                    {"mean_m_s", bin.mean_m_s()},
                    {"max_m_s", bin.max_m_s},
                    {"gust_m_s", json_of(bin.gust_m_s)},
                    {"direction_deg", json_of(direction_deg)},
                    {"state", kRecordedStateNames[static_cast<std::size_t>(bin.gravest)]}});
  }
  return rows;
}

ordered_json json_of_distribution(const SpeedDistribution& distribution) {
  return {{"class_m_s", distribution.class_m_s},
          {"share", distribution.share},
          {"weibull_shape", json_of(distribution.weibull_shape)},
          {"weibull_scale_m_s", json_of(distribution.weibull_scale_m_s)},
          {"p10_m_s", distribution.p10_m_s},
          {"p50_m_s", distribution.p50_m_s},
          {"p90_m_s", distribution.p90_m_s},
          {"p99_m_s", distribution.p99_m_s}};
}

ordered_json json_of_rose(const WindRose& rose) {
  std::array<double, kRoseClasses> from_m_s{};
  for (std::size_t i = 0; i < kRoseClasses; ++i) from_m_s.at(i) = rose.class_from_m_s(i);
  ordered_json sectors = ordered_json::object();
  for (std::size_t i = 0; i < kRoseSectors; ++i) sectors[std::string(kCompassPoints.at(i))] = rose.share[i];
  return {{"readings", rose.count}, {"calm_share", rose.calm_share}, {"class_from_m_s", from_m_s}, {"share", sectors}};
}

ordered_json json_of_sensor(const RecordingNumbers& recording, const SensorNumbers& sensor) {
  ordered_json json = {{"name", sensor.name},
                       {"driver", sensor.driver},
                       {"readings", sensor.readings},
                       {"believed", sensor.believed},
                       {"spikes", sensor.spikes},
                       {"good", sensor.quality[0]},
                       {"uncertain", sensor.quality[1]},
                       {"simulated", sensor.quality[2]},
                       {"with_direction", sensor.directed},
                       {"first_s", sensor.first_s},
                       {"last_s", sensor.last_s},
                       {"first_utc", iso_text(sensor.first)},
                       {"last_utc", iso_text(sensor.last)},
                       {"interval_s", sensor.interval_s},
                       {"unchanged_for_s", sensor.unchanged_for_s},
                       {"mean_m_s", sensor.mean_m_s},
                       {"deviation_m_s", sensor.deviation_m_s},
                       {"min_m_s", sensor.min_m_s},
                       {"max_m_s", sensor.max_m_s},
                       {"told_gust_m_s", json_of(sensor.reported_gust_m_s)},
                       {"gust_3s_m_s", json_of(sensor.gust_3s_m_s)},
                       {"direction_deg", json_of(sensor.direction_deg)},
                       {"steadiness", json_of(sensor.steadiness)},
                       {"integral_time_s", json_of(sensor.integral_time_s)},
                       {"ten_minutes",
                        {{"blocks", sensor.blocks.blocks},
                         {"turbulence_intensity", json_of(sensor.blocks.turbulence_intensity)},
                         {"gust_factor", json_of(sensor.blocks.gust_factor)}}},
                       {"distribution", json_of_distribution(sensor.distribution)},
                       {"rose", json_of_rose(sensor.rose)},
                       {"states", json_of_states(sensor)},
                       {"events", json_of_events(recording, sensor)},
                       {"spectrum", sensor.spectrum ? json_of_spectrum(*sensor.spectrum) : ordered_json(nullptr)},
                       {"default_wind", json_of_default_wind(default_wind(sensor))},
                       {"site", json_of_site(sensor.site)},
                       {"hours", nullptr},
                       {"series", json_of_series(recording, sensor)}};
  if (sensor.diurnal) {
    json["hours"] = ordered_json::array();
    for (const HourOfDay& hour : *sensor.diurnal) {
      json["hours"].push_back({{"readings", hour.count},
                               {"mean_m_s", hour.mean_m_s},
                               {"p10_m_s", hour.p10_m_s},
                               {"p90_m_s", hour.p90_m_s}});
    }
  }
  return json;
}

}  // namespace

std::string report_json(const RecordingNumbers& recording, const std::string& source) {
  const bool has_any = recording.readings > 0;
  ordered_json json = {{"recording", source},
                       {"software", with_version("yuragi")},
                       {"readings", recording.readings},
                       {"skipped", recording.skipped},
                       {"sessions", recording.sessions},
                       {"begin_s", recording.begin_s},
                       {"end_s", recording.end_s},
                       {"first_utc", has_any ? ordered_json(iso_text(recording.first)) : ordered_json(nullptr)},
                       {"last_utc", has_any ? ordered_json(iso_text(recording.last)) : ordered_json(nullptr)},
                       {"clock_sets", recording.clock_sets},
                       {"largest_clock_set_s", recording.largest_clock_set_s},
                       {"stale_intervals", recording.stale_intervals},
                       {"sensors", ordered_json::array()}};
  for (const SensorNumbers& sensor : recording.sensors) json["sensors"].push_back(json_of_sensor(recording, sensor));
  return json_text(json, 1) + "\n";
}

}  // namespace yuragi::daemon::tools::report
