#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/settings/config.hpp"
#include "drivers/windlog/windlog_writer.hpp"

namespace yuragi::daemon::tools::offline {

/// 2026-05-01T12:00:00Z, a Friday: in Berlin it is 14:00.
inline constexpr UtcTime kFridayNoon{std::chrono::sys_days(std::chrono::year(2026) / 5 / 1) + std::chrono::hours(12)};

/// Three sensors, of which one has twice the wind of the others and a calibration for that, and a small meadow.
inline std::string installation_text(const std::string& shaping = "", const std::string& yard = "") {
  return "[shaping]\n" + shaping + R"(
[[sensor]]
name = "mast"
driver = "nmea"
device = "/dev/mast"
[sensor.blend]
priority = 1

[[sensor]]
name = "roof"
driver = "line"
device = "/dev/roof"
[sensor.blend]
priority = 1
[sensor.calibration]
gain = 0.5
north_offset = 30

[[sensor]]
name = "yard"
driver = "line"
device = "/dev/yard"
[sensor.blend]
priority = 1
)" + yard +
         R"(
[[scene]]
kind = "grass"
blades_across = 8
blades_deep = 8
)";
}

inline std::string recorded_text(const std::string& text) {
  return settings::to_recorded_toml(settings::parse_config(text, "sample"));
}

struct RecordedWind {
  std::string sensor;
  std::function<double(double time_s)> speed_m_s;
  double direction_deg = 270.0;
  double interval_s = 1.0;
};

/// A gusty wind of 5 m/s, of elementary arithmetic alone, so that it is the same everywhere.
inline double gusty_m_s(double time_s) {
  const double phase = time_s / 7.0 - std::floor(time_s / 7.0);
  return 4.0 + 8.0 * phase * (1.0 - phase) + 0.01 * std::fmod(time_s, 13.0);
}

/// Appends a session of so many seconds, in the order of time.
inline void record_session(const std::filesystem::path& file, UtcTime begin, double duration_s,
                           const std::string& configuration, const std::vector<RecordedWind>& winds,
                           MonoTime mono = MonoTime(std::chrono::hours(1))) {
  auto writer = drivers::windlog::Writer::open(file);
  ASSERT_TRUE(writer) << writer.error().message;
  ASSERT_TRUE(writer->begin_session({{mono, begin}, "yuragi 0.2.0", configuration}));
  for (const RecordedWind& wind : winds) {
    const auto id = writer->add_sensor(wind.sensor, "line", "");
    ASSERT_TRUE(id);
    const auto count = static_cast<int>(duration_s / wind.interval_s);
    for (int i = 0; i < count; ++i) {
      const Nanoseconds since = from_seconds(i * wind.interval_s);
      wind::Reading reading;
      reading.time = {mono + since, begin + since};
      reading.speed_m_s = wind.speed_m_s(i * wind.interval_s);
      reading.direction_deg = wind.direction_deg;
      ASSERT_TRUE(writer->append(*id, reading));
    }
  }
  const auto closed = writer->close();
  ASSERT_TRUE(closed) << closed.error().message;
}

/// What the three sensors of installation_text() say in a gusty wind.
inline std::vector<RecordedWind> three_winds(double interval_s = 1.0) {
  return {{.sensor = "mast", .speed_m_s = gusty_m_s, .interval_s = interval_s},
          {.sensor = "roof",
           .speed_m_s = [](double time_s) { return 2.0 * gusty_m_s(time_s); },
           .direction_deg = 240.0,
           .interval_s = interval_s},
          {.sensor = "yard", .speed_m_s = gusty_m_s, .interval_s = interval_s}};
}

}  // namespace yuragi::daemon::tools::offline
