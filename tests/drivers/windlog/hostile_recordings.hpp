#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi::test {

/// Changes a recording behind its back, as the sqlite3 program would.
inline void tamper(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &connection), SQLITE_OK);
  char* message = nullptr;
  EXPECT_EQ(sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, &message), SQLITE_OK) << message;
  sqlite3_free(message);
  sqlite3_close(connection);
}

/// Reads what can be read; whatever comes out is a reading, in order. Answers how many there were.
inline std::size_t read_warily(const std::filesystem::path& file) {
  auto reader = drivers::windlog::Reader::open(file);
  if (!reader) {
    EXPECT_NE(reader.error().message.find(file.filename().string()), std::string::npos) << reader.error().message;
    return 0;
  }
  std::size_t count = 0;
  for (;;) {
    const auto logged = reader->next();
    if (!logged) {
      EXPECT_NE(logged.error().message.find(file.filename().string()), std::string::npos) << logged.error().message;
      break;
    }
    if (!*logged) break;
    EXPECT_TRUE(wind::is_plausible((*logged)->reading));
    EXPECT_GE((*logged)->log_time.count(), 0);
    EXPECT_LT((*logged)->sensor, reader->sensors().size());
    ++count;
  }
  return count;
}

/// Speed, direction, gust and quality of rows that cannot be readings.
inline constexpr std::array kImpossibleValues = {
    "'fast', NULL, NULL, 0",  // types
    "NULL, NULL, NULL, 0",   "x'00', NULL, NULL, 0",    "1.0, 'west', NULL, 0",
    "1.0, NULL, 'none', 0",  "1.0, NULL, NULL, 'good'", "1.0, NULL, NULL, NULL",
    "-1.0, NULL, NULL, 0",  // values
    "121.0, NULL, NULL, 0",  "9e999, NULL, NULL, 0",    "1.0, 360.0, NULL, 0",
    "1.0, NULL, -0.1, 0",    "1.0, NULL, NULL, 3",      "1.0, NULL, NULL, -1",
};

/// A reading of 1 m/s and one of 2 m/s are all that is read; so many rows are passed over.
inline void expect_speeds_1_and_2(const std::filesystem::path& file, std::size_t passed_over) {
  auto reader = drivers::windlog::Reader::open(file);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->next()->value().reading.speed_m_s, 1.0);
  EXPECT_EQ(reader->next()->value().reading.speed_m_s, 2.0);
  EXPECT_FALSE(reader->next()->has_value());
  EXPECT_EQ(reader->skipped(), passed_over);
}

}  // namespace yuragi::test
