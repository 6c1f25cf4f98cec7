#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/windlog/windlog_reader.hpp"
#include "drivers/windlog/windlog_writer.hpp"

namespace yuragi::test {

inline Instant at_ms(std::int64_t mono_ms, std::int64_t utc_ms) {
  return {MonoTime(std::chrono::milliseconds(mono_ms)), UtcTime(std::chrono::milliseconds(utc_ms))};
}

inline constexpr std::int64_t kSampleUtc_ms = 1'532'095'200'000;  // 2018-07-20T14:00:00Z

inline wind::Reading reading_at(std::int64_t mono_ms, double speed_m_s) {
  wind::Reading reading;
  reading.time = at_ms(mono_ms, kSampleUtc_ms + mono_ms);
  reading.speed_m_s = speed_m_s;
  return reading;
}

/// Writes a session of one sensor and closes the file.
inline void write_session(const std::filesystem::path& file, const std::vector<wind::Reading>& readings,
                          const std::string& sensor = "mast", const std::string& driver = "synthetic",
                          const std::string& options = "speed = 5") {
  auto writer = drivers::windlog::Writer::open(file);
  ASSERT_TRUE(writer) << writer.error().message;
  const Instant started = readings.empty() ? at_ms(0, kSampleUtc_ms) : readings.front().time;
  ASSERT_TRUE(writer->begin_session({started, "yuragi test", "[wind]\n"}));
  const auto id = writer->add_sensor(sensor, driver, options);
  ASSERT_TRUE(id);
  for (const wind::Reading& reading : readings) ASSERT_TRUE(writer->append(*id, reading));
  const auto closed = writer->close();
  ASSERT_TRUE(closed) << closed.error().message;
}

/// `count` readings, ten a second from 1 s on, each with a speed that tells which one it is.
inline std::vector<wind::Reading> numbered_readings(std::size_t count) {
  std::vector<wind::Reading> readings;
  for (std::size_t i = 0; i < count; ++i) {
    readings.push_back(reading_at(1000 + 100 * static_cast<std::int64_t>(i), 0.001 * static_cast<double>(i)));
  }
  return readings;
}

/// All that a recording gives, or a test that fails.
inline std::vector<drivers::windlog::LoggedReading> read_all(const std::filesystem::path& file) {
  std::vector<drivers::windlog::LoggedReading> all;
  auto reader = drivers::windlog::Reader::open(file);
  EXPECT_TRUE(reader) << (reader ? "" : reader.error().message);
  while (reader) {
    const auto logged = reader->next();
    EXPECT_TRUE(logged) << (logged ? "" : logged.error().message);
    if (!logged || !*logged) break;
    all.push_back(**logged);
  }
  return all;
}

inline void expect_same(const wind::Reading& a, const wind::Reading& b) {
  EXPECT_EQ(a.time.mono, b.time.mono);
  EXPECT_EQ(a.time.utc, b.time.utc);
  EXPECT_EQ(a.speed_m_s, b.speed_m_s);
  EXPECT_EQ(a.direction_deg, b.direction_deg);
  EXPECT_EQ(a.gust_m_s, b.gust_m_s);
  EXPECT_EQ(a.quality, b.quality);
}

}  // namespace yuragi::test
