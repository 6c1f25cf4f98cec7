// Writing and reading back recordings that are as they should be.
#include <algorithm>
#include <array>
#include <fstream>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "drivers/windlog/format.hpp"
#include "drivers/windlog/verify_recording.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using namespace std::chrono_literals;
using test::at_ms;
using test::numbered_readings;
using test::read_all;
using test::reading_at;
using test::write_session;

std::size_t count_files(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(Windlog, GivesBackEveryReadingExactly) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> speed(0.0, wind::kMaxPlausibleSpeed_m_s);
  std::uniform_real_distribution<double> direction(0.0, 360.0);
  std::uniform_int_distribution<std::int64_t> step_ns(1, 2'000'000'000);
  std::vector<wind::Reading> readings(3000);
  Instant time = test::at_ms(5, test::kSampleUtc_ms);
  for (wind::Reading& reading : readings) {
    const Nanoseconds step(step_ns(random));
    time = {time.mono + step, time.utc + step};
    reading.time = time;
    reading.speed_m_s = speed(random);
    if (random() % 2 == 0) reading.direction_deg = direction(random);
    if (random() % 3 == 0) reading.gust_m_s = speed(random);
    reading.quality = static_cast<wind::ReadingQuality>(random() % 3);
  }

  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", readings);
  const auto logged = test::read_all(folder / "a.windlog");
  ASSERT_EQ(logged.size(), readings.size());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    test::expect_same(logged[i].reading, readings[i]);
    EXPECT_EQ(logged[i].log_time, readings[i].time.mono - readings.front().time.mono);
  }
}

TEST(Windlog, IsOneFileOnceItIsClosed) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(100));
  EXPECT_EQ(count_files(folder.path()), 1U);
}

TEST(Windlog, IsReadWhileItIsWritten) {
  const test::TemporaryFolder folder;
  auto writer = Writer::open(folder / "a.windlog");
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, 0), "yuragi test", ""}));
  const auto sensor = writer->add_sensor("mast", "synthetic", "");
  ASSERT_TRUE(writer->append(*sensor, test::reading_at(1, 1.0)));
  ASSERT_TRUE(writer->commit());

  // The reader sees what is committed, and what is committed later.
  auto reader = Reader::open(folder / "a.windlog");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_TRUE(reader->next()->has_value());
  ASSERT_TRUE(writer->append(*sensor, test::reading_at(2, 2.0)));
  EXPECT_FALSE(reader->next()->has_value());
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(reader->next()->value().reading.speed_m_s, 2.0);

  // Closing goes well although somebody reads.
  EXPECT_TRUE(writer->close());
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 2U);
}

TEST(Windlog, LosesWhatIsNotCommittedAndNothingElse) {
  const test::TemporaryFolder folder;
  auto writer = Writer::open(folder / "a.windlog");
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, 0), "yuragi test", ""}));
  const auto sensor = writer->add_sensor("mast", "synthetic", "");
  ASSERT_TRUE(writer->append(*sensor, test::reading_at(1, 1.0)));
  ASSERT_TRUE(writer->commit());
  ASSERT_TRUE(writer->append(*sensor, test::reading_at(2, 2.0)));

  // A copy of the files as they are on the disk at this moment is what a power cut leaves.
  std::filesystem::create_directory(folder / "cut");
  for (const char* name : {"a.windlog", "a.windlog-wal"}) {
    std::filesystem::copy_file(folder / name, folder.path() / "cut" / name);
  }
  EXPECT_EQ(test::read_all(folder.path() / "cut" / "a.windlog").size(), 1U);

  // A recorder that starts again appends, and leaves one file.
  test::write_session(folder.path() / "cut" / "a.windlog", {test::reading_at(5, 5.0)});
  EXPECT_EQ(test::read_all(folder.path() / "cut" / "a.windlog").size(), 2U);
  EXPECT_EQ(count_files(folder / "cut"), 1U);
}

TEST(Windlog, RefusesAReadingThatIsNoneAndGoesOn) {
  const test::TemporaryFolder folder;
  auto writer = Writer::open(folder / "a.windlog");
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, 0), "yuragi test", ""}));
  const auto sensor = writer->add_sensor("mast", "synthetic", "");
  EXPECT_TRUE(writer->append(*sensor, test::reading_at(1, 1.0)));
  EXPECT_FALSE(writer->append(*sensor, test::reading_at(2, std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(writer->append(*sensor, test::reading_at(-5, 1.0)));
  EXPECT_TRUE(writer->close());
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 1U);
}

TEST(Windlog, KeepsSessionsApartAndCountsTheGapInUtc) {
  const test::TemporaryFolder folder;
  // The second session's machine was started anew: its monotonic clock begins again. UTC says 60 s went by.
  test::write_session(folder / "a.windlog", {test::reading_at(500'000, 1.0), test::reading_at(501'000, 2.0)});
  wind::Reading later = test::reading_at(3000, 3.0);
  later.time.utc = UtcTime(std::chrono::milliseconds(test::kSampleUtc_ms + 561'000));
  test::write_session(folder / "a.windlog", {later});

  // The third one's clock was set back by a day: it follows at once.
  wind::Reading earlier = test::reading_at(9000, 4.0);
  earlier.time.utc -= 24h;
  test::write_session(folder / "a.windlog", {earlier});

  const auto logged = test::read_all(folder / "a.windlog");
  ASSERT_EQ(logged.size(), 4U);
  EXPECT_EQ(logged[1].log_time, 1s);
  EXPECT_EQ(logged[2].log_time, 61s);
  EXPECT_EQ(logged[3].log_time, 61s + 1ns);
}

TEST(Windlog, FollowsTheMonotonicClockWhenUtcJumps) {
  const test::TemporaryFolder folder;
  std::vector<wind::Reading> readings = test::numbered_readings(20);
  for (std::size_t i = 10; i < readings.size(); ++i) readings[i].time.utc += 1h;
  test::write_session(folder / "a.windlog", readings);
  EXPECT_EQ(test::read_all(folder / "a.windlog").back().log_time, 1900ms);
}

TEST(Windlog, SeeksByLogTimeAndByUtc) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(2000));
  auto reader = Reader::open(folder / "a.windlog");
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->duration(), 199'900ms);

  reader->seek(150s);
  EXPECT_EQ(reader->next()->value().log_time, 150s);
  reader->seek(150'001ms);
  EXPECT_EQ(reader->next()->value().log_time, 150'100ms);
  reader->seek(-5s);
  EXPECT_EQ(reader->next()->value().log_time, 0s);
  reader->seek(1h);
  EXPECT_FALSE(reader->next()->has_value());

  // The first reading is at 14:00:01.
  const UtcTime begin{std::chrono::milliseconds(test::kSampleUtc_ms)};
  EXPECT_EQ(reader->log_time_of(begin)->value(), 0s);
  EXPECT_EQ(reader->log_time_of(begin + 11s)->value(), 10s);
  EXPECT_FALSE(reader->log_time_of(begin + 1h)->has_value());
}

/// Two sensors: one with a reading every 10 ms, and one with a reading 5 ms after every thousandth of them.
void write_two_sensors(const std::filesystem::path& file, int count) {
  auto writer = Writer::open(file);
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, test::kSampleUtc_ms), "yuragi test", ""}));
  const auto often = writer->add_sensor("often", "synthetic", "");
  const auto seldom = writer->add_sensor("seldom", "synthetic", "");
  for (int i = 0; i < count; ++i) {
    ASSERT_TRUE(writer->append(*often, test::reading_at(10 * i, 1.0)));
    if (i % 1000 != 0) continue;
    ASSERT_TRUE(writer->append(*seldom, test::reading_at(10 * i + 5, 2.0)));
  }
  ASSERT_TRUE(writer->close());
}

TEST(Windlog, MergesSensorsByTimeFromAnyPlaceOn) {
  const test::TemporaryFolder folder;
  write_two_sensors(folder / "a.windlog", 3000);
  const auto all = test::read_all(folder / "a.windlog");
  ASSERT_EQ(all.size(), 3003U);
  EXPECT_TRUE(std::ranges::is_sorted(all, {}, &LoggedReading::log_time));

  auto reader = Reader::open(folder / "a.windlog");
  for (const Nanoseconds from : {0ms, 5ms, 9'999ms, 10'005ms, 20'006ms}) {
    reader->seek(from);
    const auto expected = std::ranges::lower_bound(all, from, {}, &LoggedReading::log_time);
    for (auto at = expected; at != all.end(); ++at) {
      const auto next = reader->next();
      ASSERT_TRUE(next && *next);
      ASSERT_EQ((*next)->log_time, at->log_time);
      ASSERT_EQ((*next)->sensor, at->sensor);
    }
    EXPECT_FALSE(reader->next()->has_value());
  }
}

TEST(Windlog, GivesTheReadingsOfChosenSensorsOnly) {
  const test::TemporaryFolder folder;
  write_two_sensors(folder / "a.windlog", 3000);
  auto reader = Reader::open(folder / "a.windlog");
  ASSERT_TRUE(reader->choose({false, true}));
  for (const Nanoseconds expected : {5ms, 10'005ms, 20'005ms}) EXPECT_EQ(reader->next()->value().log_time, expected);
  EXPECT_FALSE(reader->next()->has_value());
  EXPECT_EQ(reader->last_log_time({false, true})->value(), 20'005ms);
  EXPECT_EQ(reader->last_log_time({true, false})->value(), 29'990ms);
}

TEST(Windlog, AMomentIsFoundInTheSeriesOfEachSensor) {
  const test::TemporaryFolder folder;
  write_two_sensors(folder / "a.windlog", 3000);
  auto reader = Reader::open(folder / "a.windlog");
  const UtcTime begin{std::chrono::milliseconds(test::kSampleUtc_ms)};
  for (const Nanoseconds at : {0ms, 3ms, 5ms, 7ms, 10'001ms, 29'989ms}) {
    reader->seek(at);
    EXPECT_EQ(reader->log_time_of(begin + at)->value(), reader->next()->value().log_time);
  }
}

TEST(Windlog, ReadsOnAsReadingsOfSeveralSensorsComeAndInOrder) {
  const test::TemporaryFolder folder;
  auto writer = Writer::open(folder / "a.windlog");
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, 0), "yuragi test", ""}));
  const auto a = writer->add_sensor("a", "synthetic", "");
  const auto b = writer->add_sensor("b", "synthetic", "");
  ASSERT_TRUE(writer->append(*a, test::reading_at(0, 1.0)));
  ASSERT_TRUE(writer->commit());
  auto reader = Reader::open(folder / "a.windlog");
  Nanoseconds last{-1};
  std::size_t count = 0;
  for (int i = 1; i < 200; ++i) {
    ASSERT_TRUE(writer->append(i % 7 == 0 ? *b : *a, test::reading_at(i, 1.0)));
    if (i % 20 != 0) continue;
    ASSERT_TRUE(writer->commit());
    while (const auto logged = reader->next().value()) {
      EXPECT_GT(logged->log_time, last);
      last = logged->log_time;
      ++count;
    }
  }
  EXPECT_EQ(count, 181U);
}

TEST(Windlog, ASessionThatBeginsWhileItIsReadIsLeftOut) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(5));
  auto reader = Reader::open(folder / "a.windlog");
  test::write_session(folder / "a.windlog", test::numbered_readings(5));
  std::size_t count = 0;
  while (reader->next()->has_value()) ++count;
  EXPECT_EQ(count, 5U);
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 10U);
}

TEST(Windlog, OfOneSensorAtOneTimeKeepsEveryReading) {
  const test::TemporaryFolder folder;
  std::vector<wind::Reading> readings;
  for (int i = 0; i < 100; ++i) readings.push_back(test::reading_at(i % 3 == 0 ? 2000 : 1000, i));
  readings.insert(readings.begin(), test::reading_at(1000, 100.0));
  test::write_session(folder / "a.windlog", readings);
  const auto all = test::read_all(folder / "a.windlog");
  EXPECT_EQ(all.size(), readings.size());
  for (const auto& logged : all) EXPECT_LT(logged.log_time % 1s, 1us);
}

TEST(Windlog, TakesAsManyBytesAReadingAsItsFormatSays) {
  const test::TemporaryFolder folder;
  for (const bool has_gust : {false, true}) {
    const auto file = folder / (has_gust ? "gust.windlog" : "plain.windlog");
    auto writer = Writer::open(file);
    ASSERT_TRUE(writer->begin_session({test::at_ms(0, test::kSampleUtc_ms), "yuragi test", ""}));
    constexpr int kCount = 20'000;
    const std::array<std::int64_t, 2> sensors = {*writer->add_sensor("a", "", ""), *writer->add_sensor("b", "", "")};
    for (int i = 0; i < kCount; ++i) {
      wind::Reading reading = test::reading_at(500'000LL * i, 0.1 * (i % 77));  // over months
      reading.time.utc += std::chrono::nanoseconds(i % 50'000);  // the two clocks read one after the other
      reading.direction_deg = 0.3 * (i % 1000);
      if (has_gust) reading.gust_m_s = reading.speed_m_s + 0.7;
      ASSERT_TRUE(writer->append(sensors[static_cast<std::size_t>(i % 2)], reading));
      if (i % 100 != 0) continue;
      ASSERT_TRUE(writer->commit());
    }
    ASSERT_TRUE(writer->close());
    const double bytes = static_cast<double>(std::filesystem::file_size(file)) / kCount;
    EXPECT_LE(bytes, has_gust ? 48.0 : 40.0);
  }
}

TEST(Windlog, CanBeAskedInSqlAsOneTable) {
  const test::TemporaryFolder folder;
  write_two_sensors(folder / "a.windlog", 2000);
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "a.windlog").c_str(), &connection), SQLITE_OK);
  const auto number = [&](const char* sql) {
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(connection, sql, -1, &statement, nullptr), SQLITE_OK) << sqlite3_errmsg(connection);
    sqlite3_step(statement);
    const std::int64_t value = sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    return value;
  };
  EXPECT_EQ(number("SELECT count(*) FROM reading"), 2002);
  EXPECT_EQ(number("SELECT utc_ns / 1000000 FROM reading WHERE sensor = 'seldom' ORDER BY utc_ns DESC"),
            test::kSampleUtc_ms + 10'005);
  sqlite3_close(connection);
}

TEST(Windlog, RemembersWhatMadeIt) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(1));
  auto reader = Reader::open(folder / "a.windlog");
  ASSERT_TRUE(reader);
  ASSERT_EQ(reader->sessions().size(), 1U);
  EXPECT_EQ(reader->sessions()[0].software, "yuragi test");
  EXPECT_EQ(reader->configuration(reader->sessions()[0].id).value(), "[wind]\n");
  ASSERT_EQ(reader->sensors().size(), 1U);
  EXPECT_EQ(reader->sensors()[0].name, "mast");
  EXPECT_EQ(reader->sensors()[0].driver, "synthetic");
  EXPECT_EQ(reader->sensors()[0].options, "speed = 5");
}

TEST(Windlog, OfNoReadingsIsARecordingToo) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", {});
  EXPECT_TRUE(test::read_all(folder / "a.windlog").empty());
}

TEST(Windlog, WriterRefusesAForeignDatabaseAndLeavesItAsItWas) {
  const test::TemporaryFolder folder;
  {
    auto foreign = sqlite::Database::open(folder / "other.db", sqlite::Access::kReadWrite);
    ASSERT_TRUE(foreign->run("CREATE TABLE precious (x); INSERT INTO precious VALUES (1)"));
  }
  const auto writer = Writer::open(folder / "other.db");
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().message.find("not a Yuragi recording"), std::string::npos) << writer.error().message;
  auto foreign = sqlite::Database::open(folder / "other.db", sqlite::Access::kReadOnly);
  EXPECT_EQ(foreign->integer("SELECT count(*) FROM sqlite_schema").value(), 1);
  EXPECT_EQ(foreign->integer("PRAGMA application_id").value(), 0);
  EXPECT_EQ(count_files(folder.path()), 1U);
}

TEST(Windlog, WriterRefusesAFileThatIsNoDatabase) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "letter.txt") << "Dear friend, the wind here is steady, and I think of you often.\n";
  const auto before = std::filesystem::file_size(folder / "letter.txt");
  const auto writer = Writer::open(folder / "letter.txt");
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().message.find("letter.txt"), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(folder / "letter.txt"), before);
}

TEST(Windlog, ANewerFormatIsRefusedByWriterAndReader) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(1));
  {
    auto database = sqlite::Database::open(folder / "a.windlog", sqlite::Access::kReadWrite);
    ASSERT_TRUE(database->run("PRAGMA user_version = 3"));
  }
  const auto writer = Writer::open(folder / "a.windlog");
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().message.find("newer"), std::string::npos);
  const auto reader = Reader::open(folder / "a.windlog");
  ASSERT_FALSE(reader);
  EXPECT_NE(reader.error().message.find("format 3"), std::string::npos);
}

TEST(Windlog, WriterSaysWhereItCannotWrite) {
  const auto writer = Writer::open("/nonexistent/folder/a.windlog");
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().message.find("/nonexistent/folder/a.windlog"), std::string::npos);
  EXPECT_NE(writer.error().message.find("folder"), std::string::npos);
}

TEST(Windlog, AFullDiskUndoesToTheLastCommitAndTheWriterLivesOn) {
  const test::TemporaryFolder folder;
  auto writer = Writer::open(folder / "a.windlog");
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, 0), "yuragi test", ""}));
  const auto sensor = writer->add_sensor("mast", "synthetic", "");
  ASSERT_TRUE(writer->append(*sensor, test::reading_at(1, 1.0)));
  ASSERT_TRUE(writer->commit());

  std::string failure;
  {
    const test::FileSizeLimit limit(200'000);
    for (int i = 2; i < 100'000 && failure.empty(); ++i) {
      if (const auto done = writer->append(*sensor, test::reading_at(i, 1.0)); !done) failure = done.error().message;
      if (i % 500 != 0 || !failure.empty()) continue;
      if (const auto done = writer->commit(); !done) failure = done.error().message;
    }
  }
  EXPECT_NE(failure.find("a.windlog"), std::string::npos) << failure;

  // What was committed before is there, and there is room again.
  EXPECT_TRUE(writer->append(*sensor, test::reading_at(1'000'000, 2.0)));
  EXPECT_TRUE(writer->close());
  const auto logged = test::read_all(folder / "a.windlog");
  ASSERT_GE(logged.size(), 2U);
  EXPECT_EQ(logged.size() % 500, 1U);
  EXPECT_EQ(logged.back().reading.speed_m_s, 2.0);
}

TEST(Windlog, ManyAtOnceAreAsOneByOne) {
  const test::TemporaryFolder folder;
  std::vector<wind::Reading> readings = test::numbered_readings(200);
  readings[70].time = readings[69].time;  // at one time
  readings[140].time.mono = readings[130].time.mono;
  readings[3].direction_deg = 12.5;
  readings[4].gust_m_s = 7.0;
  readings[5].quality = wind::ReadingQuality::kUncertain;
  test::write_session(folder / "one.windlog", readings);
  for (const Durability durability : {Durability::kEachCommit, Durability::kOnceClosed}) {
    const auto file = folder / (durability == Durability::kEachCommit ? "many.windlog" : "once.windlog");
    auto writer = Writer::open(file, durability);
    ASSERT_TRUE(writer) << writer.error().message;
    ASSERT_TRUE(writer->begin_session({readings.front().time, "yuragi test", "[wind]\n"}));
    const auto id = writer->add_sensor("mast", "synthetic", "speed = 5");
    ASSERT_TRUE(writer->append(*id, std::span(readings).first(1)));
    ASSERT_TRUE(writer->append(*id, std::span(readings).subspan(1)));
    ASSERT_TRUE(writer->close());
    const auto one = test::read_all(folder / "one.windlog");
    const auto many = test::read_all(file);
    ASSERT_EQ(many.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) test::expect_same(many[i].reading, one[i].reading);
    EXPECT_TRUE(verify_recording(file, 60s).value().is_sound());
  }
}

TEST(Windlog, TwoSensorsOfOneNameKeepTheirReadingsApart) {
  const test::TemporaryFolder folder;
  auto writer = Writer::open(folder / "a.windlog");
  ASSERT_TRUE(writer);
  const auto readings = test::numbered_readings(64);
  ASSERT_TRUE(writer->begin_session({readings.front().time, "yuragi test", ""}));
  const auto one = writer->add_sensor("mast", "synthetic", "");
  const auto other = writer->add_sensor("mast", "synthetic", "");
  ASSERT_TRUE(writer->append(*one, readings));
  ASSERT_TRUE(writer->append(*other, readings));
  ASSERT_TRUE(writer->close());
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 128U);
}

}  // namespace
}  // namespace yuragi::drivers::windlog
