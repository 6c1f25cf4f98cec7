#include "daemon/tools/sensors/sensor_table.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "daemon/sensing/refusal_text.hpp"
#include "engine/base/compass.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::sensors {
namespace {

/// Returns true if recordings are the only live sensors.
bool is_replayed(const std::vector<wire::SensorStatus>& sensors) {
  const auto is_used = [](const wire::SensorStatus& sensor) { return is_believed(sensor.state); };
  return std::ranges::any_of(sensors, is_used) &&
         std::ranges::none_of(sensors, [&](const auto& sensor) { return is_used(sensor) && !sensor.replayed; });
}

std::string_view wind_source(const wire::Sensors& sensors) {
  switch (sensors.wind.source) {
    case wind::Source::kDefault:
      return "default wind: no sensor is live";
    case wind::Source::kHandover:
      return "handing over";
    case wind::Source::kLive:
      return is_replayed(sensors.sensors) ? "REPLAY of a recording" : "live";
  }
  return "?";
}

/// In capitals for trouble, and if it is not the present wind.
std::string state_text(wind::judging::SensorState state) {
  std::string text(name_of(state));
  const bool is_quiet = state == wind::judging::SensorState::kLive || state == wind::judging::SensorState::kSimulated ||
                        state == wind::judging::SensorState::kConnecting;
  if (!is_quiet) std::ranges::transform(text, text.begin(), [](char c) { return static_cast<char>(c - 'a' + 'A'); });
  return state == wind::judging::SensorState::kReplayed ? "REPLAY" : text;
}

std::string direction_text(double direction_deg) {
  return fmt::format("{:3.0f} {}", direction_deg, nearest_compass_point(direction_deg));
}

std::string optional_text(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

/// Ten metres and more without decimals, so that a number that changes keeps its width.
std::string short_number(double value) {
  return fmt::format("{:.{}f}", value, value < 9.95 ? 1 : 0);
}

/// The place of the wind on top of the table, and when its gusts reach the middle of the scenes; empty if that is 0.
std::string place_of_wind(const wind::State& wind) {
  if (!wind.is_place_configured && wind.upwind_m == 0.0) return {};
  std::string text = wind.is_place_configured ? "at the sensors, " : "at the windward edge, ";
  if (std::abs(wind.upwind_m) < 0.05) {
    text += "level with the middle of the scenes";
  } else {
    text += fmt::format("{} m {} of the middle of the scenes", short_number(std::abs(wind.upwind_m)),
                        wind.upwind_m > 0.0 ? "upwind" : "downwind");
  }
  if (wind.to_middle_s > 0.0) text += fmt::format("; a gust reaches it in {} s", short_number(wind.to_middle_s));
  return text;
}

/// How far gusts are alike at the site; empty if that is not known.
std::string reach_text(const wire::Sensors& sensors) {
  const auto one = [](const std::optional<double>& times, std::string_view where) {
    return times ? fmt::format("{:.2f} times as far {} the wind", *times, where) : std::string();
  };
  const std::string across = one(sensors.gust_reach_across, "across");
  const std::string along = one(sensors.gust_reach_along, "along");
  if (across.empty() && along.empty()) return {};
  return fmt::format("gusts are alike {}{}{} as usually; learnt from these sensors", across,
                     across.empty() || along.empty() ? "" : " and ", along);
}

/// "0.05, 0.20, 12.50 ms". The percentiles are upper ends of classes; none is above the maximum, which is exact.
std::string lateness_text(const wire::Lateness& lateness) {
  return fmt::format("{:.2f}, {:.2f}, {:.2f} ms", 1e3 * std::min(lateness.p50_s, lateness.max_s),
                     1e3 * std::min(lateness.p99_s, lateness.max_s), 1e3 * lateness.max_s);
}

/// How the daemon does; empty if it does not report it.
std::string service_text(const wire::Sensors& sensors) {
  if (!sensors.io_lateness) return {};
  return fmt::format(
      "since the start: clients refused {}, stuck {}, idle {}; late in the last 10 min (p50, p99, most): I/O {}{}",
      sensors.refused_clients, sensors.stuck_clients, sensors.idle_clients, lateness_text(*sensors.io_lateness),
      sensors.tick_lateness ? "; ticks " + lateness_text(*sensors.tick_lateness) : "");
}

/// How the recording does; empty if nothing is recorded.
std::string recorder_text(const wire::Sensors& sensors) {
  if (!sensors.recorder) return {};
  const wire::RecorderStatus& recorder = *sensors.recorder;
  std::string text = fmt::format("recorded {}, waiting {}, lost {}", count_text(recorder.written, "reading"),
                                 recorder.waiting, recorder.lost);
  if (recorder.recorded_elsewhere > 0) text += fmt::format(", by another process {}", recorder.recorded_elsewhere);
  if (recorder.free_bytes) text += fmt::format("; {:.1f} GB free", 1e-9 * static_cast<double>(*recorder.free_bytes));
  switch (recorder.state) {
    case wire::RecorderState::kWriting:
      return text;
    case wire::RecorderState::kRetrying:
      return text + "; CANNOT WRITE, trying again: " + recorder.error;
    case wire::RecorderState::kHanging:
      return text + "; HANGS: " + recorder.error;
  }
  return text;
}

/// From here on it is shown how many times the group's wind a sensor reads. The page has the same.
constexpr double kShownTimesGroup = 1.03;

/// `text` under a row: indented, broken between words.
std::string wrapped(std::string_view text) {
  constexpr std::size_t kWidth = 100;
  std::string result;
  std::string line = " ";
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (line.size() > 4 && line.size() + 1 + word.size() > kWidth) {
      result += line + "\n";
      line = "   ";
    }
    line += fmt::format(" {}", word);
  }
  return result + line + "\n";
}

}  // namespace

std::string sensor_table(const wire::Sensors& sensors) {
  const wind::Vector wind = sensors.wind.wind;
  std::string table = fmt::format("wind {:.1f} m/s from {} ({})   clients {}   ticks skipped {}\n", speed_of(wind),
                                  direction_text(wind::direction_from_deg(wind)), wind_source(sensors), sensors.clients,
                                  sensors.recent_skipped_ticks);
  if (const std::string place = place_of_wind(sensors.wind); !place.empty()) table += wrapped(place);
  if (const std::string reach = reach_text(sensors); !reach.empty()) table += wrapped(reach);
  if (!sensors.shaping.text.empty()) table += wrapped("shaped: " + sensors.shaping.text);
  if (const std::string recorder = recorder_text(sensors); !recorder.empty()) table += wrapped(recorder);
  if (const std::string service = service_text(sensors); !service.empty()) table += fmt::format("  {}\n", service);
  table += '\n';
  const auto out = std::back_inserter(table);
  const auto row = [&](const auto&... cells) {
    fmt::format_to(out, "{:<12.12} {:<10.10} {:<12} {:>6} {:>7} {:>6} {:>7} {:>7} {:>9} {:>9} {:>5}\n", cells...);
  };
  row("sensor", "driver", "state", "m/s", "from", "gust", "age s", "every s", "frames", "readings", "again");
  for (const wire::SensorStatus& sensor : sensors.sensors) {
    row(sensor.name, sensor.driver, state_text(sensor.state), optional_text(sensor.speed_m_s, "{:.2f}"),
        sensor.direction_deg ? direction_text(*sensor.direction_deg) : "-", optional_text(sensor.gust_m_s, "{:.2f}"),
        sensor.readings > 0 ? fmt::format("{:.1f}", sensor.age_s) : "-",
        sensor.interval_s > 0.0 ? fmt::format("{:.2f}", sensor.interval_s) : "-", sensor.frames, sensor.readings,
        sensor.reconnects);
    if (!sensor.state_reason.empty()) {
      table += wrapped(fmt::format("{}: {}", name_of(sensor.state), sensor.state_reason));
    }
    if (!sensor.value.empty()) table += wrapped("speed: " + sensor.value);
    if (std::abs(std::log(sensor.reads_times_group)) >= std::log(kShownTimesGroup)) {
      table += wrapped(fmt::format("reads {:.2f} times the group", sensor.reads_times_group));
    }
    for (const wire::QuantityStatus& quantity : sensor.quantities) {
      if (quantity.is_missing) table += wrapped(fmt::format("no {}: {}", name_of(quantity.quantity), quantity.reason));
    }
    if (!sensor.detail.empty() && sensor.detail != sensor.state_reason) {
      table += wrapped(fmt::format("{}: {}", name_of(sensor.link), sensor.detail));
    }
    if (!sensor.refused.empty()) table += wrapped("refused: " + sensing::refusal_text(sensor));
  }
  return table;
}

}  // namespace yuragi::daemon::tools::sensors
