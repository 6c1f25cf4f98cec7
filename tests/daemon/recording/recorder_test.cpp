#include "daemon/recording/recorder.hpp"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <future>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "drivers/windlog/recording_parts.hpp"
#include "drivers/windlog/series_lock.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::recording {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kHour_ms = 3'600'000;

Info info_of(std::vector<RecordedSensor> sensors, Instant started = test::at_ms(0, test::kSampleUtc_ms)) {
  return {.started = started,
          .software = "yuragi test",
          .configuration = "[wind]\nspeed = 4\n",
          .sensors = std::move(sensors)};
}

/// Waits until the recorder's status is so; only a recorder that hangs makes it give up.
void wait_for(const Recorder& recorder, const std::function<bool(const RecorderStatus&)>& is_so) {
  ASSERT_TRUE(recorder.wait_until(is_so, std::chrono::seconds(60)));
}

TEST(Recorder, WritesEverythingByItsEndAndLeavesOneFile) {
  const test::TemporaryFolder folder;
  const auto readings = test::numbered_readings(5000);
  {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "modbus", "host = \"sim\""}, {"roof", "synthetic", ""}}));
    for (std::size_t i = 0; i < readings.size(); ++i) EXPECT_TRUE(recorder.push(i % 2, readings[i]));
  }
  auto reader = drivers::windlog::Reader::open(folder / "a.windlog");
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->configuration(reader->sessions()[0].id).value(), "[wind]\nspeed = 4\n");
  const auto logged = test::read_all(folder / "a.windlog");
  ASSERT_EQ(logged.size(), readings.size());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    test::expect_same(logged[i].reading, readings[i]);
    EXPECT_EQ(reader->sensors()[logged[i].sensor].name, i % 2 == 0 ? "mast" : "roof");
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

wind::StationQuantities temperature_at(std::int64_t mono_ms, double air_temperature_c) {
  wind::StationQuantities quantities;
  quantities.time = test::at_ms(mono_ms, test::kSampleUtc_ms + mono_ms);
  quantities.air_temperature_c = air_temperature_c;
  return quantities;
}

/// Nothing where the recording cannot be read now: a file of it may be renamed meanwhile.
std::optional<std::vector<double>> temperatures_now_in(const std::filesystem::path& file) {
  std::vector<double> all;
  auto reader = drivers::windlog::Reader::open(file);
  if (!reader || !reader->each_quantities(Nanoseconds{0}, Nanoseconds::max(),
                                          [&](const drivers::windlog::LoggedQuantities& logged) {
                                            all.push_back(logged.quantities.air_temperature_c.value_or(-1.0));
                                          }))
    return std::nullopt;
  return all;
}

std::vector<double> temperatures_in(const std::filesystem::path& file) {
  const auto all = temperatures_now_in(file);
  EXPECT_TRUE(all);
  return all.value_or(std::vector<double>{});
}

TEST(Recorder, WritesWhatStationsSayBesidesTheWind) {
  const test::TemporaryFolder folder;
  {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "nmea", ""}, {"roof", "nmea", ""}}));
    for (const auto& reading : test::numbered_readings(50)) EXPECT_TRUE(recorder.push(0, reading));
    EXPECT_TRUE(recorder.push(0, temperature_at(2000, 11.0)));
    EXPECT_TRUE(recorder.push(1, temperature_at(2000, 12.0)));
    EXPECT_TRUE(recorder.push(1, temperature_at(4000, 13.0)));
    EXPECT_FALSE(recorder.push(2, temperature_at(4000, 13.0)));
  }
  EXPECT_EQ(temperatures_in(folder / "a.windlog"), (std::vector<double>{11.0, 12.0, 13.0}));
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 50U);
}

TEST(Recorder, LosesNoReadingToATableOfQuantitiesThatIsDamaged) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(5));
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "a.windlog").c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, "CREATE TABLE quantity (text TEXT)", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(database);

  std::vector<std::string> reports;
  {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "nmea", ""}}),
                      [&](std::string_view sentence) { reports.emplace_back(sentence); });
    for (const auto& reading : test::numbered_readings(50)) EXPECT_TRUE(recorder.push(0, reading));
    EXPECT_TRUE(recorder.push(0, temperature_at(2000, 11.0)));
  }
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 55U);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_NE(reports[0].find("1 message of stations, besides the wind, could not be recorded"), std::string::npos)
      << reports[0];
}

/// The parts of a recording that are there, the oldest first, and the file that is written.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files;
  for (const auto& part : drivers::windlog::completed_parts(file)) files.push_back(part.file);
  files.push_back(file);
  return files;
}

TEST(Recorder, WaitsWhileAnotherOneRecordsToTheSameSeriesAndTakesOverWhenThatHasEnded) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  const auto readings = test::numbered_readings(40);
  std::optional<Recorder> first(std::in_place, file, info_of({{"mast", "", ""}}), RecorderReport(), RecorderLimits(),
                                settings::RecordingConfig{.most_file_bytes = 1});
  std::vector<std::string> reports;
  Recorder second(file, info_of({{"roof", "", ""}}),
                  [&](std::string_view sentence) { reports.emplace_back(sentence); });
  EXPECT_EQ(second.status().state, RecorderState::kRetrying);
  EXPECT_NE(second.status().error.find("records to " + file.string()), std::string::npos) << second.status().error;

  for (std::size_t i = 0; i < 10; ++i) second.push(0, readings[i]);
  for (std::size_t i = 10; i < 30; i += 10) {  // it completes a file meanwhile
    for (std::size_t j = i; j < i + 10; ++j) first->push(0, readings[j]);
    wait_for(*first, [&](const RecorderStatus& status) { return status.written == i; });
  }
  EXPECT_EQ(second.status().state, RecorderState::kRetrying);
  EXPECT_EQ(second.status().written, 0U);
  EXPECT_EQ(second.status().waiting, 10U);
  first.reset();
  wait_for(second, [](const RecorderStatus& status) { return status.recorded_elsewhere == 10; });
  for (std::size_t i = 30; i < 40; ++i) second.push(0, readings[i]);
  wait_for(second, [](const RecorderStatus& status) { return status.written == 10; });
  EXPECT_EQ(second.status().waiting, 0U);
  EXPECT_EQ(second.status().lost, 0U);
  second.close();
  const auto logged = test::read_all(file);
  ASSERT_EQ(logged.size(), 30U) << "10 to 29 by the first, 30 to 39 by the second";
  for (std::size_t i = 0; i < logged.size(); ++i) test::expect_same(logged[i].reading, readings[i + 10]);
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_EQ(reports[1], "resumed; 0 readings lost, 10 recorded by another process");
}

TEST(Recorder, WritesWhatTheOneBeforeItHadNotCommittedWhenItEnded) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  const auto readings = test::numbered_readings(20);
  std::optional<Recorder> first(std::in_place, file, info_of({{"mast", "", ""}}));
  Recorder second(file, info_of({{"mast", "", ""}}));
  for (std::size_t i = 0; i < 10; ++i) first->push(0, readings[i]);
  for (std::size_t i = 0; i < 20; ++i) second.push(0, readings[i]);
  first.reset();
  wait_for(second, [](const RecorderStatus& status) { return status.written > 0; });
  EXPECT_EQ(second.status().written, 10U);
  EXPECT_EQ(second.status().recorded_elsewhere, 10U);
  second.close();
  const auto logged = test::read_all(file);
  ASSERT_EQ(logged.size(), readings.size());
  for (std::size_t i = 0; i < logged.size(); ++i) test::expect_same(logged[i].reading, readings[i]);
}

TEST(Recorder, DoublesNothingWhereTheOneBeforeItEndedBetweenTwoFiles) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  const auto readings = test::numbered_readings(20);
  std::optional<drivers::windlog::SeriesLock> other(drivers::windlog::SeriesLock::take(file).value());
  Recorder second(file, info_of({{"mast", "", ""}}));
  for (const auto& reading : readings) second.push(0, reading);
  test::write_session(drivers::windlog::part_name(file, readings.front().time.utc), test::numbered_readings(15));
  other.reset();
  wait_for(second, [](const RecorderStatus& status) { return status.written > 0; });
  EXPECT_EQ(second.status().written, 5U);
  EXPECT_EQ(second.status().recorded_elsewhere, 15U);
}

TEST(Recorder, WritesWhatArrivedWhileAProgramHeldTheLockThatRecordedNothing) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  std::optional<drivers::windlog::SeriesLock> other(drivers::windlog::SeriesLock::take(file).value());
  Recorder second(file, info_of({{"mast", "", ""}}));
  for (const auto& reading : test::numbered_readings(20)) second.push(0, reading);
  other.reset();  // yuragi clean-secrets, say
  wait_for(second, [](const RecorderStatus& status) { return status.written == 20; });
  EXPECT_EQ(second.status().recorded_elsewhere, 0U);
}

TEST(Recorder, LosesNothingAtItsEndWhileAnotherOneRecords) {
  const test::TemporaryFolder folder;
  const auto other = drivers::windlog::SeriesLock::take(folder / "a.windlog");
  std::vector<std::string> reports;
  Recorder second(folder / "a.windlog", info_of({{"mast", "", ""}}),
                  [&](std::string_view sentence) { reports.emplace_back(sentence); });
  for (const auto& reading : test::numbered_readings(20)) second.push(0, reading);
  second.close();
  EXPECT_EQ(second.status().lost, 0U);
  EXPECT_EQ(second.status().recorded_elsewhere, 20U);
  EXPECT_EQ(reports.size(), 1U) << "that another one records";
}

TEST(Recorder, ShowsThatItCanRecordAlsoBeforeTheFirstReadingAfterAnotherOneHasEnded) {
  const test::TemporaryFolder folder;
  std::optional<Recorder> first(std::in_place, folder / "a.windlog", info_of({{"mast", "", ""}}));
  const Recorder second(folder / "a.windlog", info_of({{"mast", "", ""}}));
  EXPECT_EQ(second.status().state, RecorderState::kRetrying);
  first.reset();
  wait_for(second, [](const RecorderStatus& status) { return status.state == RecorderState::kWriting; });
}

TEST(Recorder, LosesAndDoublesNothingThatStationsSayWhereAFileIsCompleted) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  std::vector<double> said;
  {
    Recorder recorder(file, info_of({{"mast", "nmea", ""}, {"roof", "nmea", ""}}), {}, {}, {.most_file_bytes = 1});
    for (int i = 1; i <= 4; ++i) {
      // Several seconds before the reading that completes the file, and after it, in one go.
      for (int second = 0; second < 5; ++second) {
        said.push_back(10.0 * i + second);
        EXPECT_TRUE(recorder.push(i % 2 == 0 ? 0 : 1,
                                  temperature_at(std::int64_t{10'000} * i + std::int64_t{1000} * second, said.back())));
      }
      EXPECT_TRUE(recorder.push(0, test::reading_at(std::int64_t{10'000} * i + 2500, i)));
      wait_for(recorder, [&](const RecorderStatus& status) { return status.written == static_cast<unsigned>(i); });
    }
  }
  EXPECT_EQ(files_of(file).size(), 4U);
  EXPECT_EQ(temperatures_in(file), said);
  std::vector<double> one_by_one;
  for (const auto& part : files_of(file)) {
    const test::TemporaryFolder alone;
    std::filesystem::copy_file(part, alone / "b.windlog");
    for (const double each : temperatures_in(alone / "b.windlog")) one_by_one.push_back(each);
  }
  EXPECT_EQ(one_by_one, said);
}

TEST(Recorder, CompletesAFileThatHasNoReading) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  std::vector<double> said;
  std::vector<std::string> reports;
  constexpr std::int64_t kDay_ms = std::int64_t{24} * 3'600'000;
  for (int day = 0; day < 5; ++day) {
    Recorder recorder(file, info_of({{"mast", "nmea", ""}}),
                      [&](std::string_view sentence) { reports.emplace_back(sentence); }, {},
                      {.is_daily = true, .keep_days = 2});
    said.push_back(day);
    EXPECT_TRUE(recorder.push(0, temperature_at(day * kDay_ms + 1000, day)));
  }
  EXPECT_EQ(files_of(file).size(), 4U) << "the first day ended more than two days ago";
  said.erase(said.begin());
  EXPECT_EQ(temperatures_in(file), said);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_NE(reports[0].find("deleted"), std::string::npos) << reports[0];
}

TEST(Recorder, CompletesAFileThatHasNoReadingInTheMiddleOfARun) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  std::vector<double> said;
  {
    Recorder recorder(file, info_of({{"mast", "nmea", ""}}), {}, {}, {.most_file_bytes = 1});
    for (int i = 1; i <= 3; ++i) {
      said.push_back(i);
      EXPECT_TRUE(recorder.push(0, temperature_at(std::int64_t{10'000} * i, i)));
      const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
      while (temperatures_now_in(file) != said && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      EXPECT_EQ(temperatures_in(file), said);
    }
  }
  EXPECT_EQ(files_of(file).size(), 3U);
  EXPECT_EQ(temperatures_in(file), said);
}

TEST(Recorder, DeletesWhatStationsSaidWithTheFileThatItIsIn) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  std::vector<std::string> reports;
  {
    // A quarter of the limit is kept free: 75 kB hold two files of some 30.
    Recorder recorder(file, info_of({{"mast", "nmea", ""}}),
                      [&](std::string_view sentence) { reports.emplace_back(sentence); }, {},
                      {.most_file_bytes = 1, .most_bytes = 100'000});
    for (int i = 1; i <= 8; ++i) {
      EXPECT_TRUE(recorder.push(0, temperature_at(std::int64_t{10'000} * i, i)));
      EXPECT_TRUE(recorder.push(0, test::reading_at(std::int64_t{10'000} * i, i)));
      wait_for(recorder, [&](const RecorderStatus& status) { return status.written == static_cast<unsigned>(i); });
    }
  }
  EXPECT_GE(reports.size(), 3U);
  std::vector<double> speeds;
  for (const auto& logged : test::read_all(file)) speeds.push_back(logged.reading.speed_m_s);
  EXPECT_LT(speeds.size(), 8U);
  EXPECT_EQ(speeds.back(), 8.0);
  EXPECT_EQ(temperatures_in(file), speeds) << "of the files that are kept, all of it";
}

TEST(Recorder, KeepsWhatStationsSayWhileTheDiskIsFull) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  std::vector<double> said;
  {
    Recorder recorder(file, info_of({{"mast", "nmea", ""}}), {}, {}, {.least_free_bytes = 1});
    recorder.push(0, test::reading_at(1, 1.0));
    wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
    recorder.begin_session(info_of({{"mast", "nmea", ""}}), {.least_free_bytes = ~std::uint64_t{0}});
    for (int second = 2; second < 30; ++second) {
      said.push_back(second);
      EXPECT_TRUE(recorder.push(0, temperature_at(std::int64_t{1000} * second, second)));
    }
    recorder.push(0, test::reading_at(40'000, 2.0));
    wait_for(recorder, [](const RecorderStatus& status) { return status.state == RecorderState::kRetrying; });
    recorder.begin_session(info_of({{"mast", "nmea", ""}}), {});
    recorder.push(0, test::reading_at(50'000, 3.0));
    wait_for(recorder, [](const RecorderStatus& status) { return status.written == 3; });
  }
  EXPECT_EQ(temperatures_in(file), said);
}

/// The permissions of a file as a person writes them: 0640.
unsigned mode_of(const std::filesystem::path& file) {
  struct stat status {};
  EXPECT_EQ(stat(file.c_str(), &status), 0) << file;
  return status.st_mode & 07777U;
}

/// Sets the process's umask, and sets it back.
class Umask {
 public:
  explicit Umask(mode_t mask) : before_(umask(mask)) {}
  ~Umask() { umask(before_); }
  Umask(const Umask&) = delete;
  Umask& operator=(const Umask&) = delete;

 private:
  mode_t before_;
};

TEST(Recorder, MakesFilesThatOthersCannotRead) {
  const test::TemporaryFolder folder;
  const Umask none(0);
  const std::filesystem::path file = folder / "a.windlog";
  Recorder recorder(file, info_of({{"mast", "", ""}}));
  recorder.push(0, test::reading_at(1, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  for (const char* suffix : {"", "-wal", "-shm"}) EXPECT_EQ(mode_of(file.string() + suffix), 0640U) << suffix;
  recorder.close();
  EXPECT_EQ(mode_of(file), 0640U);
}

TEST(Recorder, MakesAFileBehindALinkThatOthersCannotReadEither) {
  const test::TemporaryFolder folder;
  const Umask none(0);
  std::filesystem::create_directory(folder / "disk");
  std::filesystem::create_symlink("disk/b.windlog", folder / "b.windlog");
  std::filesystem::create_symlink("b.windlog", folder / "a.windlog");
  { const Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}})); }
  EXPECT_EQ(mode_of(folder / "disk/b.windlog"), 0640U);
}

TEST(Recorder, KeepsToAStricterUmaskAndToTheModeOfAFileThatIsThere) {
  const test::TemporaryFolder folder;
  {
    const Umask strict(077);
    const Recorder recorder(folder / "strict.windlog", info_of({{"mast", "", ""}}));
  }
  EXPECT_EQ(mode_of(folder / "strict.windlog"), 0600U);
  test::write_session(folder / "old.windlog", test::numbered_readings(1));
  ASSERT_EQ(chmod((folder / "old.windlog").c_str(), 0664), 0);
  { const Recorder recorder(folder / "old.windlog", info_of({{"mast", "", ""}})); }
  EXPECT_EQ(mode_of(folder / "old.windlog"), 0664U);
}

TEST(Recorder, CommitsByItself) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  recorder.push(0, test::reading_at(1, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 1U);
  static_assert(RecorderLimits{}.commit_every <= std::chrono::seconds(1));
}

TEST(Recorder, AppendsASessionAtEachStart) {
  const test::TemporaryFolder folder;
  for (int run = 0; run < 3; ++run) {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
    recorder.push(0, test::reading_at(1000 * std::int64_t{run}, 1.0));
  }
  EXPECT_EQ(drivers::windlog::Reader::open(folder / "a.windlog")->sessions().size(), 3U);
}

TEST(Recorder, BeginsASessionWithAnotherConfigurationBetweenTwoReadings) {
  const test::TemporaryFolder folder;
  const auto readings = test::numbered_readings(3000);
  {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}, {"roof", "", ""}}));
    Info next = info_of({{"mast", "", ""}, {"roof", "", "rate = 4"}});
    for (std::size_t i = 0; i < readings.size(); ++i) {
      if (i == 1000) {
        next.configuration = "[wind]\nspeed = 5\n";
        recorder.begin_session(next, {});
      }
      if (i == 2000) {  // of two before the next reading only the last matters
        recorder.begin_session(next, {});
        next.configuration = "[wind]\nspeed = 6\n";
        recorder.begin_session(next, {});
      }
      EXPECT_TRUE(recorder.push(i % 2, readings[i]));
      if (i == 500 || i == 1500) {
        wait_for(recorder, [i](const RecorderStatus& status) { return status.written == i + 1; });
      }
    }
    recorder.begin_session(next, {});  // and one that gets no reading
  }
  auto reader = drivers::windlog::Reader::open(folder / "a.windlog");
  ASSERT_TRUE(reader);
  ASSERT_EQ(reader->sessions().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(reader->configuration(reader->sessions()[i].id).value(),
              "[wind]\nspeed = " + std::to_string(4 + i) + "\n");
  }
  const auto logged = test::read_all(folder / "a.windlog");
  ASSERT_EQ(logged.size(), readings.size());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    test::expect_same(logged[i].reading, readings[i]);
    EXPECT_EQ(logged[i].log_time, readings[i].time.mono - readings[0].time.mono) << "no gap";
  }
}

TEST(Recorder, TakesNewRulesAlthoughReadingsWaitBecauseOfTheOldOnes) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  recorder.push(0, test::reading_at(1, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  recorder.begin_session(info_of({{"mast", "", ""}}), {.least_free_bytes = ~std::uint64_t{0}});
  recorder.push(0, test::reading_at(2, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.state == RecorderState::kRetrying; });
  recorder.begin_session(info_of({{"mast", "", ""}}), {});
  recorder.push(0, test::reading_at(3, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 3; });
  EXPECT_EQ(recorder.status().lost, 0U);
}

TEST(Recorder, KeepsARecordingOfAnOlderFormatUnderAnotherName) {
  const test::TemporaryFolder folder;
  const std::string old = test::source_path("tests/drivers/windlog/format1.windlog");
  std::vector<std::string> reports;
  for (int run = 0; run < 2; ++run) {
    std::filesystem::copy_file(old, folder / "a.windlog", std::filesystem::copy_options::overwrite_existing);
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}),
                      [&](std::string_view report) { reports.emplace_back(report); });
    recorder.push(0, test::reading_at(1, 1.0));
  }
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 1U);
  EXPECT_EQ(test::read_all(folder / "a-format1.windlog").size(), 34U);
  EXPECT_EQ(test::read_all(folder / "a-format1-2.windlog").size(), 34U);
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_NE(reports[1].find("a-format1-2.windlog"), std::string::npos) << reports[1];
}

TEST(Recorder, CountsWhatCannotBeRecorded) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  EXPECT_FALSE(recorder.push(0, test::reading_at(1, -3.0)));
  EXPECT_FALSE(recorder.push(1, test::reading_at(1, 3.0)));
  EXPECT_EQ(recorder.status().lost, 2U);
}

TEST(Recorder, CanBeginWithoutItsFolderAndRecordsOnceItIsThere) {
  const test::TemporaryFolder folder;
  const auto file = folder / "disk" / "a.windlog";
  Recorder recorder(file, info_of({{"mast", "", ""}}), {}, {.commit_every = std::chrono::milliseconds(1)}, {},
                    kSynchronizedFile, RecorderStart::kRetries);
  EXPECT_EQ(recorder.status().state, RecorderState::kRetrying);
  EXPECT_NE(recorder.status().error.find("disk/a.windlog"), std::string::npos) << recorder.status().error;
  EXPECT_NE(recorder.status().error.find(" (since 20"), std::string::npos) << recorder.status().error;
  EXPECT_TRUE(recorder.push(0, test::reading_at(1, 3.0)));
  std::filesystem::create_directory(folder / "disk");
  EXPECT_TRUE(
      recorder.wait_until([](const RecorderStatus& status) { return status.written == 1; }, std::chrono::seconds(60)));
  EXPECT_EQ(recorder.status().state, RecorderState::kWriting);
  EXPECT_EQ(recorder.status().lost, 0U);
}

TEST(Recorder, OverwritesNoForeignFileHoweverOftenItTries) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  std::ofstream(file) << "my diary";
  {
    Recorder recorder(file, info_of({{"mast", "", ""}}), {}, {.commit_every = std::chrono::milliseconds(1)}, {},
                      kSynchronizedFile, RecorderStart::kRetries);
    EXPECT_TRUE(recorder.push(0, test::reading_at(1, 3.0)));
    EXPECT_TRUE(recorder.wait_until([](const RecorderStatus& status) { return !status.error.empty(); },
                                    std::chrono::seconds(60)));
  }
  std::string text;
  std::getline(std::ifstream(file), text);
  EXPECT_EQ(text, "my diary");
}

TEST(Recorder, RefusesToStartWhereItCannotWrite) {
  try {
    const Recorder recorder("/nonexistent/a.windlog", info_of({}));
    FAIL() << "it started";
  } catch (const FailureError& error) {
    EXPECT_EQ(error.kind(), FailureKind::kCannotCreate);
    EXPECT_NE(std::string(error.what()).find("/nonexistent/a.windlog"), std::string::npos);
  }
}

TEST(Recorder, SurvivesAFullDiskAndGoesOnWhenThereIsRoom) {
  const test::TemporaryFolder folder;
  std::vector<std::string> reports;
  const auto readings = test::numbered_readings(20'000);
  {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}),
                      [&](std::string_view report) { reports.emplace_back(report); });
    recorder.push(0, readings[0]);
    wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
    {
      const test::FileSizeLimit full(150'000);
      for (std::size_t i = 1; i < 10'000; ++i) EXPECT_TRUE(recorder.push(0, readings[i]));
      wait_for(recorder, [](const RecorderStatus& status) { return !status.error.empty(); });
      EXPECT_NE(recorder.status().error.find("a.windlog"), std::string::npos);
      EXPECT_EQ(recorder.status().written, 1U);
    }
    wait_for(recorder, [](const RecorderStatus& status) { return status.written == 10'000; });
    EXPECT_EQ(recorder.status().error, "");
    EXPECT_EQ(recorder.status().lost, 0U);
  }
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_NE(reports[0].find("interrupted"), std::string::npos);
  EXPECT_NE(reports[1].find("resumed"), std::string::npos);
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 10'000U);
}

TEST(Recorder, CountsWhatADiskThatStaysFullTakesAway) {
  const test::TemporaryFolder folder;
  std::string last_report;
  const test::FileSizeLimit full(150'000);
  {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}),
                      [&](std::string_view report) { last_report = report; });
    for (const wind::Reading& reading : test::numbered_readings(10'000)) recorder.push(0, reading);
  }
  EXPECT_NE(last_report.find("10000 readings that could not be written"), std::string::npos) << last_report;
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 0U);
}

TEST(Recorder, ThatCannotWriteForLongHoldsABoundedNumberAndRefusesTheRest) {
  const test::TemporaryFolder folder;
  const test::FileSizeLimit full(150'000);
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  const wind::Reading reading = test::reading_at(1, 1.0);
  std::uint64_t refused = 0;
  std::uint64_t pushed = 0;
  for (; refused < 1000; ++pushed) {
    if (!recorder.push(0, reading)) ++refused;
    if (pushed % 10'000 == 0) std::this_thread::yield();
  }
  EXPECT_EQ(recorder.status().lost, refused);
  EXPECT_EQ(recorder.status().written, 0U);
}

TEST(Recorder, BeginsTheFileAnewWhereItWasRemoved) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  recorder.push(0, test::reading_at(1, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) std::filesystem::remove(entry.path());
  recorder.push(0, test::reading_at(2, 2.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 2; });
  const auto logged = test::read_all(folder / "a.windlog");
  ASSERT_EQ(logged.size(), 1U);
  EXPECT_EQ(logged[0].reading.speed_m_s, 2.0);
}

TEST(Recorder, CompletesAFileThatIsMovedAndContinuesUnderTheName) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  recorder.push(0, test::reading_at(1, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  std::filesystem::rename(folder / "a.windlog", folder / "b.windlog");
  recorder.push(0, test::reading_at(2, 2.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 2; });
  EXPECT_EQ(test::read_all(folder / "b.windlog").size(), 1U);
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 1U);
}

TEST(Recorder, NoticesThatAnotherFileHasTakenItsName) {
  const test::TemporaryFolder folder;
  { Recorder older(folder / "older.windlog", info_of({{"mast", "", ""}})); }
  std::vector<std::string> reports;
  {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}),
                      [&](std::string_view report) { reports.emplace_back(report); });
    recorder.push(0, test::reading_at(1, 1.0));
    wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
    std::filesystem::rename(folder / "a.windlog", folder / "b.windlog");
    std::filesystem::rename(folder / "older.windlog", folder / "a.windlog");
    recorder.push(0, test::reading_at(2, 2.0));
    wait_for(recorder, [](const RecorderStatus& status) { return status.written == 2; });
  }
  ASSERT_FALSE(reports.empty());
  EXPECT_NE(reports[0].find("replaced by another file"), std::string::npos) << reports[0];
  EXPECT_EQ(test::read_all(folder / "b.windlog").size(), 1U);
  const auto logged = test::read_all(folder / "a.windlog");
  ASSERT_EQ(logged.size(), 1U);
  EXPECT_EQ(logged[0].reading.speed_m_s, 2.0);
}

TEST(Recorder, WritesToItsOpenFileWhileTheNameCannotBeLookedUp) {
  const test::TemporaryFolder folder;
  const std::filesystem::path link = folder / "link";
  std::filesystem::create_directory(folder / "real");
  std::filesystem::create_directory_symlink(folder / "real", link);
  std::vector<std::string> reports;
  {
    Recorder recorder(link / "a.windlog", info_of({{"mast", "", ""}}),
                      [&](std::string_view report) { reports.emplace_back(report); });
    std::filesystem::remove(link);
    std::filesystem::create_directory_symlink(link, link);
    EXPECT_EQ(drivers::windlog::identity_of(link / "a.windlog").error(), std::errc::too_many_symbolic_link_levels);
    recorder.push(0, test::reading_at(1, 1.0));
    wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  }
  EXPECT_EQ(reports, std::vector<std::string>{});
  EXPECT_EQ(test::read_all(folder / "real" / "a.windlog").size(), 1U);
}

/// Replaces system calls of SQLite while it lives.
class ReplacedCalls {
 public:
  ReplacedCalls(std::initializer_list<const char*> names, sqlite3_syscall_ptr replacement) {
    sqlite3_initialize();
    sqlite3_vfs* const vfs = sqlite3_vfs_find(nullptr);
    for (const char* name : names) {
      originals_.emplace_back(name, vfs->xGetSystemCall(vfs, name));
      vfs->xSetSystemCall(vfs, name, replacement);
    }
  }
  ~ReplacedCalls() {
    sqlite3_vfs* const vfs = sqlite3_vfs_find(nullptr);
    for (const auto& [name, original] : originals_) vfs->xSetSystemCall(vfs, name, original);
  }
  ReplacedCalls(const ReplacedCalls&) = delete;
  ReplacedCalls& operator=(const ReplacedCalls&) = delete;

 private:
  std::vector<std::pair<const char*, sqlite3_syscall_ptr>> originals_;
};

/// Holds every write of SQLite's to the disk while it is closed, as a disk that hangs does.
class DiskGate {
 public:
  static void set_open(bool is_open) {
    is_open_ = is_open;
    is_open_.notify_all();
  }

 private:
  static ssize_t write_when_open(int file, const void* bytes, std::size_t size, off_t offset) {
    is_open_.wait(false);
    return pwrite(file, bytes, size, offset);
  }

  static inline std::atomic<bool> is_open_{true};
  const ReplacedCalls calls_{{"pwrite", "pwrite64"}, reinterpret_cast<sqlite3_syscall_ptr>(&write_when_open)};
};

TEST(Recorder, ADiskThatHangsIsAStateAndTheReadingsWait) {
  const test::TemporaryFolder folder;
  const DiskGate gate;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}), {}, {.hang_after = Nanoseconds{0}});
  DiskGate::set_open(false);
  recorder.push(0, test::reading_at(1, 1.0));
  while (recorder.status().state != RecorderState::kHanging) std::this_thread::yield();
  recorder.push(0, test::reading_at(2, 1.0));
  EXPECT_EQ(recorder.status().waiting, 2U);
  EXPECT_EQ(recorder.status().written, 0U);
  EXPECT_NE(recorder.status().error.find("a.windlog: the disk does not respond"), std::string::npos);
  DiskGate::set_open(true);
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 2; });
  recorder.close();
  EXPECT_EQ(recorder.status().state, RecorderState::kWriting);
  EXPECT_EQ(recorder.status().waiting, 0U);
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 2U);
}

TEST(Recorder, EndsAlthoughItsDiskHangsAndSaysWhatWasNotWritten) {
  const test::TemporaryFolder folder;
  const DiskGate gate;
  std::vector<std::string> reports;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}),
                    [&](std::string_view report) { reports.emplace_back(report); },
                    {.hang_after = Nanoseconds{0}, .most_at_end = Nanoseconds{0}});
  DiskGate::set_open(false);
  for (int i = 0; i < 3; ++i) recorder.push(0, test::reading_at(i, 1.0));
  while (recorder.status().state != RecorderState::kHanging) std::this_thread::yield();
  recorder.close();
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_NE(reports[0].find("3 readings"), std::string::npos) << reports[0];

  // What its thread had in hand is written when the disk answers after all, and is not reported any more.
  DiskGate::set_open(true);
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 3; });
  while (std::filesystem::exists(folder / "a.windlog-wal")) std::this_thread::yield();
  EXPECT_EQ(reports.size(), 1U);
}

TEST(Recorder, BeginsAFileADayAndDeletesTheOldest) {
  const test::TemporaryFolder folder;
  std::vector<std::string> reports;
  constexpr int kDays = 5;
  for (int day = 0; day < kDays; ++day) {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}),
                      [&](std::string_view report) { reports.emplace_back(report); }, {},
                      {.is_daily = true, .keep_days = 3});
    for (int hour = 0; hour < 2; ++hour) {
      recorder.push(0, test::reading_at((24 * day + hour) * kHour_ms, day));
      wait_for(recorder,
               [&](const RecorderStatus& status) { return status.written == 1U + static_cast<unsigned>(hour); });
    }
  }
  const auto all = test::read_all(folder / "a.windlog");
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front().reading.speed_m_s, 1.0) << "the first day ended more than three days ago";
  EXPECT_EQ(all.back().reading.speed_m_s, kDays - 1.0);
  EXPECT_EQ(all.size(), 2U * (kDays - 1));
  EXPECT_EQ(test::read_all(folder / "a-20180721T140000Z.windlog").size(), 2U);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_NE(reports[0].find("deleted"), std::string::npos) << reports[0];
}

/// Records readings 1 to `count` into files of one reading each.
void record_parts(const std::filesystem::path& file, int first, int count) {
  Recorder recorder(file, info_of({{"mast", "", ""}}), {}, {}, {.most_file_bytes = 1});
  for (int i = first; i < first + count; ++i) {
    recorder.push(0, test::reading_at(std::int64_t{1000} * i, i));
    wait_for(recorder,
             [&](const RecorderStatus& status) { return status.written == static_cast<unsigned>(i - first + 1); });
  }
}

/// A recorder of a file a day, with what it reported. Its clock shows `ahead` more than monotonic time, which goes on
/// from one to the next.
class DailyRecorder {
 public:
  DailyRecorder(const std::filesystem::path& folder, std::chrono::hours at, std::chrono::hours ahead = {})
      : recorder_(
            folder / "a.windlog", info_of({{"mast", "", ""}}, time_of(at, ahead)),
            [this](std::string_view report) { reports_.emplace_back(report); },
            {.commit_every = std::chrono::milliseconds(1)}, {.is_daily = true, .keep_days = 180},
            folder / "synchronized") {}

  void record(Nanoseconds at, std::chrono::hours ahead = {}) {
    wind::Reading reading;
    reading.time = time_of(at, ahead);
    reading.speed_m_s = 1.0;
    EXPECT_TRUE(recorder_.push(0, reading));
    ++count_;
    wait_for(recorder_, [this](const RecorderStatus& status) { return status.written == count_; });
  }

  RecorderStatus status() const { return recorder_.status(); }
  /// Of a recorder that is at rest: record() has returned.
  const std::vector<std::string>& reports() const { return reports_; }

 private:
  static Instant time_of(Nanoseconds at, std::chrono::hours ahead) {
    return {MonoTime(at), UtcTime(std::chrono::milliseconds(test::kSampleUtc_ms)) + at + ahead};
  }

  std::vector<std::string> reports_;
  Recorder recorder_;
  std::uint64_t count_ = 0;
};

constexpr std::chrono::hours kDay = std::chrono::days(1);

std::size_t count_parts(const test::TemporaryFolder& folder) {
  return drivers::windlog::completed_parts(folder / "a.windlog").size();
}

/// Records six parts and what the seventh is to become.
void record_a_week(const test::TemporaryFolder& folder) {
  DailyRecorder recorder(folder.path(), kDay);
  for (int day = 1; day <= 7; ++day) recorder.record(day * kDay);
  EXPECT_TRUE(recorder.reports().empty());
}

TEST(Recorder, ADateThatJumpsDeletesNothing) {
  const test::TemporaryFolder folder;
  record_a_week(folder);
  ASSERT_EQ(count_parts(folder), 6U);
  DailyRecorder recorder(folder.path(), 7 * kDay);
  recorder.record(7 * kDay);
  for (int second = 1; second <= 5; ++second) recorder.record(7 * kDay + std::chrono::seconds(second), 400 * kDay);
  EXPECT_EQ(count_parts(folder), 7U);
  ASSERT_TRUE(recorder.status().clock_doubt);
  const std::string text = text_of(*recorder.status().clock_doubt);
  EXPECT_NE(text.find("it jumped ahead by 400 days"), std::string::npos) << text;
  ASSERT_EQ(recorder.reports().size(), 1U);
  EXPECT_EQ(recorder.reports()[0].substr(0, 60), text.substr(0, 60));
  const auto all = test::read_all(folder / "a.windlog");
  ASSERT_EQ(all.size(), 13U);
  EXPECT_EQ(all.back().reading.time.utc, UtcTime(std::chrono::milliseconds(test::kSampleUtc_ms)) + 407 * kDay + 5s)
      << "as it was, though it is doubted";
}

TEST(Recorder, AStartAtAWrongDateDeletesNothing) {
  const test::TemporaryFolder folder;
  record_a_week(folder);
  DailyRecorder recorder(folder.path(), 7 * kDay, 400 * kDay);
  for (int second = 1; second <= 5; ++second) recorder.record(7 * kDay + std::chrono::seconds(second), 400 * kDay);
  EXPECT_EQ(count_parts(folder), 7U);
  ASSERT_TRUE(recorder.status().clock_doubt);
  EXPECT_TRUE(recorder.status().clock_doubt->is_at_start);
}

TEST(Recorder, AfterADayOfDoubtAgeDeletesTwoPartsForEachThatIsCompleted) {
  const test::TemporaryFolder folder;
  record_a_week(folder);
  {
    DailyRecorder recorder(folder.path(), 7 * kDay, 400 * kDay);
    recorder.record(7 * kDay, 400 * kDay);
    recorder.record(7 * kDay + std::chrono::hours(8), 400 * kDay);
  }
  EXPECT_EQ(count_parts(folder), 7U);
  ASSERT_TRUE(std::filesystem::exists(folder / "a.windlog-clock"));
  DailyRecorder recorder(folder.path(), 8 * kDay, 400 * kDay);
  EXPECT_TRUE(recorder.status().clock_doubt) << "saved";
  for (const std::chrono::hours hour : {0h, 8h, 16h - 1h}) recorder.record(8 * kDay + hour, 400 * kDay);
  EXPECT_TRUE(recorder.status().clock_doubt);
  EXPECT_EQ(count_parts(folder), 9U);
  recorder.record(8 * kDay + 16h, 400 * kDay);
  EXPECT_FALSE(recorder.status().clock_doubt);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.windlog-clock"));
  for (int second = 1; second <= 3; ++second)
    recorder.record(8 * kDay + 16h + std::chrono::seconds(second), 400 * kDay);
  EXPECT_EQ(count_parts(folder), 7U) << "two for the one that was completed last";
  recorder.record(10 * kDay, 400 * kDay);
  recorder.record(10 * kDay + 1s, 400 * kDay);
  EXPECT_EQ(count_parts(folder), 6U) << "one more, and two less";
}

TEST(Recorder, BelievesAClockThatIsKnownToBeSynchronized) {
  const test::TemporaryFolder folder;
  record_a_week(folder);
  DailyRecorder recorder(folder.path(), 7 * kDay, 40 * kDay);
  recorder.record(7 * kDay, 40 * kDay);
  EXPECT_TRUE(recorder.status().clock_doubt);
  const auto now = UtcTime(std::chrono::milliseconds(test::kSampleUtc_ms)) + 47 * kDay;
  std::ofstream(folder / "synchronized").flush();
  std::filesystem::last_write_time(folder / "synchronized", std::chrono::file_clock::from_sys(now));
  recorder.record(7 * kDay + 1s, 40 * kDay);
  EXPECT_FALSE(recorder.status().clock_doubt);
  ASSERT_EQ(recorder.reports().size(), 2U);
  EXPECT_EQ(recorder.reports()[1], "the clock is trusted again");
}

TEST(Recorder, ADoubtedClockHoldsUpNoRuleOfSpace) {
  const test::TemporaryFolder folder;
  record_parts(folder / "a.windlog", 1, 3);
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}), {}, {}, {.most_bytes = 4});
  recorder.push(0, test::reading_at(24 * kHour_ms * 400, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  EXPECT_TRUE(recorder.status().clock_doubt);
  EXPECT_EQ(count_parts(folder), 0U);
}

TEST(Recorder, RotatesOnAfterAStartAYearAhead) {
  const test::TemporaryFolder folder;
  {
    DailyRecorder recorder(folder.path(), kDay, 365 * kDay);
    recorder.record(kDay, 365 * kDay);
  }
  DailyRecorder recorder(folder.path(), kDay);
  for (int day = 1; day <= 3; ++day) recorder.record(day * kDay);
  EXPECT_EQ(count_parts(folder), 3U) << "the one of next year, and two days";
  const auto all = test::read_all(folder / "a.windlog");
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0].reading.time.utc, all[1].reading.time.utc + 365 * kDay) << "read in the order of recording";
}

TEST(Recorder, BeginsANewFileInTheMiddleOfARun) {
  const test::TemporaryFolder folder;
  {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}), {}, {}, {.most_file_bytes = 1});
    for (int i = 1; i <= 3; ++i) {
      recorder.push(0, test::reading_at(i, i));
      wait_for(recorder, [&](const RecorderStatus& status) { return status.written == static_cast<unsigned>(i); });
    }
    EXPECT_EQ(recorder.status().lost, 0U);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 3);
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 3U);
}

std::vector<double> speeds_in(const std::filesystem::path& file) {
  std::vector<double> speeds;
  for (const auto& logged : test::read_all(file)) speeds.push_back(logged.reading.speed_m_s);
  return speeds;
}

TEST(Recorder, CompletesAFileThatAnotherProgramReadsWithAllItsReadings) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  Recorder recorder(file, info_of({{"mast", "", ""}}), {}, {}, {.is_daily = true});
  recorder.push(0, test::reading_at(1000, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  // In the midst of a query, so that the next reading stays beside the file.
  sqlite3* reader = nullptr;
  ASSERT_EQ(sqlite3_open_v2(file.c_str(), &reader, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(reader, "BEGIN; SELECT count(*) FROM session", nullptr, nullptr, nullptr), SQLITE_OK);
  recorder.push(0, test::reading_at(2000, 2.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 2; });
  recorder.push(0, test::reading_at(24 * kHour_ms, 3.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 3; });
  EXPECT_TRUE(std::filesystem::exists(folder / "a-20180720T140000Z.windlog"));
  EXPECT_EQ(speeds_in(file), (std::vector{1.0, 2.0, 3.0}));
  sqlite3_close(reader);
}

/// Calls something as this thread's SQLite reads for the first time of a database that it has opened, before it opens
/// what lies beside it.
class AtTheFirstRead {
 public:
  explicit AtTheFirstRead(std::function<void()> call) { call_ = std::move(call); }
  ~AtTheFirstRead() { call_ = nullptr; }
  AtTheFirstRead(const AtTheFirstRead&) = delete;
  AtTheFirstRead& operator=(const AtTheFirstRead&) = delete;

 private:
  static ssize_t call_and_read(int file, void* bytes, std::size_t size, off_t offset) {
    if (call_) std::exchange(call_, nullptr)();
    return pread(file, bytes, size, offset);
  }

  static inline thread_local std::function<void()> call_;
  const ReplacedCalls calls_{{"pread", "pread64"}, reinterpret_cast<sqlite3_syscall_ptr>(&call_and_read)};
};

TEST(Recorder, CompletesAFileOnlyWhereNobodyOfItsProcessIsAboutToOpenIt) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  const auto part = folder / "a-20180720T140000Z.windlog";
  Recorder recorder(file, info_of({{"mast", "", ""}}), {}, {.commit_every = std::chrono::milliseconds(1)},
                    {.is_daily = true});
  recorder.push(0, test::reading_at(1000, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  {
    // As the history does it, at midnight: it has opened the file, and would find what is beside the next day's.
    const AtTheFirstRead hook([&] {
      recorder.push(0, test::reading_at(24 * kHour_ms, 2.0));
      constexpr auto kEnoughToRename = std::chrono::milliseconds(500);
      recorder.wait_until([](const RecorderStatus& status) { return status.written == 2; }, kEnoughToRename);
    });
    const auto speeds = speeds_in(file);
    ASSERT_FALSE(speeds.empty());
    EXPECT_EQ(speeds.front(), 1.0);
  }
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 2; });
  EXPECT_TRUE(std::filesystem::exists(part));
  recorder.push(0, test::reading_at(25 * kHour_ms, 3.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 3; });
  EXPECT_EQ(speeds_in(file), (std::vector{1.0, 2.0, 3.0}));
}

/// A recording that a killed process left, with its newest reading beside it.
void leave_unclosed(const std::filesystem::path& file) {
  const test::TemporaryFolder folder;
  auto writer = drivers::windlog::Writer::open(folder / "b.windlog").value();
  ASSERT_TRUE(writer.begin_session({test::at_ms(0, test::kSampleUtc_ms), "yuragi test", ""}));
  const auto sensor = writer.add_sensor("mast", "", "").value();
  ASSERT_TRUE(writer.append(sensor, test::reading_at(1000, 1.0)));
  ASSERT_TRUE(writer.commit());
  std::filesystem::copy_file(folder / "b.windlog", file);
  std::filesystem::copy_file(folder / "b.windlog-wal", file.string() + "-wal");
}

TEST(Recorder, KilledBetweenTheStepsOfARenameLosesNothing) {
  for (int steps = 0; steps <= 3; ++steps) {
    const test::TemporaryFolder folder;
    const auto file = folder / "a.windlog";
    const auto part = folder / "a-20180720T140000Z.windlog";
    leave_unclosed(file);
    if (steps >= 1) std::filesystem::rename(file.string() + "-wal", part.string() + "-wal");
    if (steps >= 2) std::filesystem::rename(file, part);
    if (steps >= 3) std::ofstream(file).flush();  // the next file is created, and nothing is in it
    record_parts(file, 2, 2);
    EXPECT_EQ(speeds_in(file), (std::vector{1.0, 2.0, 3.0})) << "after " << steps << " steps";
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      const std::string name = entry.path();
      EXPECT_TRUE(std::filesystem::exists(name.substr(0, name.rfind(".windlog")) + ".windlog")) << name;
    }
  }
}

TEST(Recorder, LeavesTheSpaceFreeThatItIsToldTo) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}), {}, {},
                    {.least_free_bytes = std::numeric_limits<std::uint64_t>::max() / 2});
  recorder.push(0, test::reading_at(1, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.state == RecorderState::kRetrying; });
  EXPECT_NE(recorder.status().error.find("min_free"), std::string::npos) << recorder.status().error;
  EXPECT_EQ(recorder.status().written, 0U);
}

TEST(Recorder, ACopyOfTheFileAloneIsARecordingFromTheBeginningOn) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}), {},
                    {.commit_every = std::chrono::milliseconds(1)});
  std::filesystem::copy_file(folder / "a.windlog", folder / "begin.windlog");
  EXPECT_EQ(drivers::windlog::Reader::open(folder / "begin.windlog")->sensors().size(), 1U);
  for (int i = 1; i <= 1 + RecorderWorker::kCommitsPerCheckpoint; ++i) {
    recorder.push(0, test::reading_at(i, 1.0));
    wait_for(recorder, [&](const RecorderStatus& status) { return status.written == static_cast<unsigned>(i); });
  }
  std::filesystem::copy_file(folder / "a.windlog", folder / "later.windlog");
  EXPECT_GE(test::read_all(folder / "later.windlog").size(),
            static_cast<unsigned>(RecorderWorker::kCommitsPerCheckpoint));
}

TEST(Recorder, SaysHowMuchSpaceIsLeft) {
  const test::TemporaryFolder folder;
  const Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  const auto space = std::filesystem::space(folder.path());
  ASSERT_TRUE(recorder.status().free_bytes);
  EXPECT_NEAR(static_cast<double>(*recorder.status().free_bytes), static_cast<double>(space.available), 1e9);
}

TEST(Recorder, KilledAtAnyMomentLeavesARecordingOfAllThatWasCommitted) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "a.windlog";
  std::array<int, 2> output{};
  ASSERT_EQ(pipe(output.data()), 0);
  const std::string program = test::built_path("tests/daemon/recorder_child");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    dup2(output[1], STDOUT_FILENO);
    execl(program.c_str(), program.c_str(), file.c_str(), nullptr);
    _exit(127);
  }
  close(output[1]);

  // It says how many readings it has committed; at the third time it dies.
  FILE* lines = fdopen(output[0], "r");
  ASSERT_NE(lines, nullptr);
  unsigned long long committed = 0;
  for (int line = 0; line < 3; ++line) ASSERT_EQ(std::fscanf(lines, "%llu", &committed), 1);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  while (std::fscanf(lines, "%llu", &committed) == 1) {
  }
  std::fclose(lines);

  // Everything that it said is there, in order, with nothing missing in between.
  const auto logged = test::read_all(file);
  EXPECT_GE(logged.size(), committed);
  for (std::size_t i = 0; i < logged.size(); ++i) {
    EXPECT_EQ(logged[i].reading.speed_m_s, 0.001 * static_cast<double>(i));
  }

  // So is what the station said, a second each.
  const auto said = temperatures_in(file);
  EXPECT_GE(said.size(), committed / 200);
  for (std::size_t i = 0; i < said.size(); ++i) EXPECT_EQ(said[i], static_cast<double>(i % 50));

  // The next start mends the file and appends.
  { Recorder recorder(file, info_of({{"mast", "", ""}})); }
  EXPECT_EQ(test::read_all(file).size(), logged.size());
  EXPECT_EQ(temperatures_in(file), said);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace yuragi::daemon::recording
