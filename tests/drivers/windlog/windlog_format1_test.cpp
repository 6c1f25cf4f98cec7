// Recordings of version 1 of the format: they stay readable.
#include <stop_token>

#include <gtest/gtest.h>

#include "drivers/windlog/format.hpp"
#include "drivers/windlog/windlog_cursor.hpp"
#include "tests/drivers/windlog/hostile_recordings.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using namespace std::chrono_literals;
using test::numbered_readings;
using test::read_all;
using test::read_warily;
using test::reading_at;
using test::tamper;

/// Made by yuragi 0.2.0: two sessions of 3 s, in each 13 readings of "roof" and 4 of "mast".
std::filesystem::path kept_recording() {
  return test::source_path("tests/drivers/windlog/format1.windlog");
}

constexpr const char* kSchemaOfFormat1 = R"sql(
CREATE TABLE IF NOT EXISTS session (
  id INTEGER PRIMARY KEY, started_utc_ns INTEGER NOT NULL, started_mono_ns INTEGER NOT NULL, software TEXT NOT NULL,
  configuration TEXT NOT NULL
) STRICT;
CREATE TABLE IF NOT EXISTS sensor (
  id INTEGER PRIMARY KEY, session INTEGER NOT NULL REFERENCES session (id), name TEXT NOT NULL, driver TEXT NOT NULL,
  options TEXT NOT NULL
) STRICT;
CREATE TABLE IF NOT EXISTS reading (
  session INTEGER NOT NULL REFERENCES session (id), sensor INTEGER NOT NULL REFERENCES sensor (id),
  utc_ns INTEGER NOT NULL, mono_ns INTEGER NOT NULL, speed_m_s REAL NOT NULL, direction_deg REAL, gust_m_s REAL,
  quality INTEGER NOT NULL
) STRICT;
CREATE INDEX IF NOT EXISTS reading_by_time ON reading (session, mono_ns);
)sql";

/// Writes a session of one sensor.
void write_format1(const std::filesystem::path& file, const std::vector<wind::Reading>& readings) {
  std::string sql = "BEGIN; PRAGMA application_id = " + std::to_string(kApplicationId) + "; PRAGMA user_version = 1;";
  sql += kSchemaOfFormat1;
  sql +=
      "INSERT INTO session (started_utc_ns, started_mono_ns, software, configuration) VALUES (0, 0, 'yuragi test', '');"
      "INSERT INTO sensor (session, name, driver, options) SELECT max(id), 'mast', 'synthetic', '' FROM session;";
  for (const wind::Reading& reading : readings) {
    sql += "INSERT INTO reading SELECT max(session.id), max(sensor.id), " +
           std::to_string(reading.time.utc.time_since_epoch().count()) + ", " +
           std::to_string(reading.time.mono.time_since_epoch().count()) + ", " + std::to_string(reading.speed_m_s) +
           ", NULL, NULL, 0 FROM session, sensor;";
  }
  tamper(file, sql + "COMMIT;");
}

TEST(Format1, ARecordingOfAnOlderVersionIsReadInFull) {
  const auto all = read_all(kept_recording());
  ASSERT_EQ(all.size(), 34U);
  auto reader = Reader::open(kept_recording());
  ASSERT_TRUE(reader) << reader.error().message;
  ASSERT_EQ(reader->sessions().size(), 2U);
  EXPECT_EQ(reader->sessions()[0].software, "yuragi 0.2.0");
  ASSERT_EQ(reader->sensors().size(), 4U);
  EXPECT_EQ(reader->sensors()[all[1].sensor].name, "mast");
  EXPECT_EQ(all.front().reading.time.utc.time_since_epoch().count(), 1'795'397'261'869'339'929);
  EXPECT_EQ(all.front().reading.speed_m_s, 4.133723620457918);
  EXPECT_EQ(all.back().log_time.count(), 6'106'749'581);
  EXPECT_EQ(all.back().reading.direction_deg, 255.90214880089428);
  EXPECT_EQ(reader->duration(), all.back().log_time);
  EXPECT_NE(reader->configuration(1)->find("kind = 'grass'"), std::string::npos);
}

TEST(Format1, OneSensorIsReadByItself) {
  auto cursor = Cursor::open(kept_recording(), "mast");
  ASSERT_TRUE(cursor) << cursor.error().message;
  std::size_t count = 0;
  for (auto logged = cursor->next(); logged && *logged; logged = cursor->next(), ++count) {
    EXPECT_EQ(cursor->sensor_of(**logged).name, "mast");
  }
  EXPECT_EQ(count, 8U);
}

TEST(Format1, IsNotContinued) {
  const test::TemporaryFolder folder;
  write_format1(folder / "a.windlog", numbered_readings(3));
  const auto writer = Writer::open(folder / "a.windlog");
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().message.find("older Yuragi"), std::string::npos) << writer.error().message;
  EXPECT_EQ(read_all(folder / "a.windlog").size(), 3U);
}

TEST(Format1, AScanEndsWhenItIsToldTo) {
  const test::TemporaryFolder folder;
  write_format1(folder / "a.windlog", numbered_readings(20'000));
  std::stop_source stop;
  auto reader = Reader::open(folder / "a.windlog", stop.get_token());
  ASSERT_TRUE(reader);
  stop.request_stop();
  const auto found = reader->last_log_time({false});
  EXPECT_TRUE(found) << "nothing is looked at for it";
  const auto late = reader->log_time_of(UtcTime(std::chrono::milliseconds(test::kSampleUtc_ms + 1'999'000)));
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().message.find("interrupted"), std::string::npos) << late.error().message;
}

/// Replaces the table of readings by one that takes anything.
void loosen(const std::filesystem::path& file) {
  tamper(file,
         "CREATE TABLE loose (session, sensor, utc_ns, mono_ns, speed_m_s, direction_deg, gust_m_s, quality);"
         "INSERT INTO loose SELECT * FROM reading; DROP TABLE reading; ALTER TABLE loose RENAME TO reading;");
}

TEST(HostileFormat1, RowsThatCannotBeReadingsArePassedOverAndCounted) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  write_format1(file, {reading_at(1000, 1.0), reading_at(9000, 2.0)});
  loosen(file);
  std::vector<std::string> bad_rows = {
      "1, 1, 'today', 2000000000, 1.0, NULL, NULL, 0",  // clocks
      "1, 1, NULL, 2000000000, 1.0, NULL, NULL, 0",
      "1, 1, 5, 2000.5e6, 1.0, NULL, NULL, 0",
      "1, 1, 9223372036854775807, 2000000000, 1.0, NULL, NULL, 0",
      "1, 1, -9223372036854775808, 2000000000, 1.0, NULL, NULL, 0",
      "1, NULL, 5, 2000000000, 1.0, NULL, NULL, 0",  // sensors
      "1, 77, 5, 2000000000, 1.0, NULL, NULL, 0",
  };
  for (const char* values : test::kImpossibleValues) bad_rows.push_back(std::string("1, 1, 5, 2000000000, ") + values);
  for (const std::string& row : bad_rows) tamper(file, "INSERT INTO reading VALUES (" + row + ")");
  test::expect_speeds_1_and_2(file, bad_rows.size());
}

TEST(HostileFormat1, RowsAtTimesBeyondAllMeasureChangeNothing) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  write_format1(file, {reading_at(1000, 1.0), reading_at(9000, 2.0)});
  loosen(file);
  for (const char* mono_ns : {"-1", "-9223372036854775808", "9223372036854775807", "'noon'", "NULL"}) {
    tamper(file, std::string("INSERT INTO reading VALUES (1, 1, 5, ") + mono_ns + ", 1.0, NULL, NULL, 0)");
  }
  EXPECT_EQ(read_warily(file), 2U);
  EXPECT_EQ(Reader::open(file)->duration(), std::chrono::seconds(8));
}

TEST(HostileFormat1, SessionsWhoseTimesAddUpToTooMuchAreRefused) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  wind::Reading last = reading_at(0, 1.0);
  last.time.mono = MonoTime(Nanoseconds(kMaxTime_ns));
  for (int i = 0; i < 3; ++i) write_format1(file, {reading_at(0, 1.0), last});
  const auto reader = Reader::open(file);
  ASSERT_FALSE(reader);
  EXPECT_NE(reader.error().message.find("session 2"), std::string::npos) << reader.error().message;
}

TEST(HostileFormat1, AViewInPlaceOfATableIsNotRun) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  write_format1(file, {reading_at(1000, 1.0)});
  tamper(file,
         "DROP TABLE reading; CREATE VIEW reading AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) "
         "SELECT 1 AS session, 1 AS sensor, x AS utc_ns, x AS mono_ns, 1.0 AS speed_m_s, NULL AS direction_deg, "
         "NULL AS gust_m_s, 0 AS quality FROM n");
  EXPECT_FALSE(Reader::open(file));
}

TEST(HostileFormat1, AFileThatLacksATableOrAColumnIsRefused) {
  const test::TemporaryFolder folder;
  for (const char* sql : {"DROP TABLE session", "DROP TABLE sensor", "DROP TABLE reading",
                          "ALTER TABLE reading DROP COLUMN gust_m_s", "PRAGMA user_version = 0"}) {
    const auto file = folder / "a.windlog";
    std::filesystem::remove(file);
    write_format1(file, {reading_at(1000, 1.0)});
    tamper(file, std::string("PRAGMA foreign_keys = OFF; ") + sql);
    EXPECT_FALSE(Reader::open(file)) << sql;
  }
}

TEST(HostileFormat1, OfARecordingWithoutItsIndexIsReadAllTheSame) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  write_format1(file, numbered_readings(2000));
  tamper(file, "DROP INDEX reading_by_time");
  EXPECT_EQ(read_all(file).size(), 2000U);
}

}  // namespace
}  // namespace yuragi::drivers::windlog
