#include "daemon/recording/recorder.hpp"

#include <array>
#include <csignal>
#include <cstdio>
#include <future>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::recording {
namespace {

using test::numbered_readings;
using test::read_all;
using test::reading_at;

RecordingInfo info_of(std::vector<RecordedSensor> sensors) {
  return {.started = test::at_ms(0, test::kSampleUtc_ms),
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
  auto reader = drivers::windlog::WindlogReader::open(folder / "a.windlog");
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

TEST(Recorder, CommitsByItself) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  recorder.push(0, test::reading_at(1, 1.0));
  wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 1U);
  static_assert(Recorder::kCommitInterval <= std::chrono::milliseconds(500));
}

TEST(Recorder, AppendsASessionAtEachStart) {
  const test::TemporaryFolder folder;
  for (int run = 0; run < 3; ++run) {
    Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
    recorder.push(0, test::reading_at(1000 * std::int64_t{run}, 1.0));
  }
  EXPECT_EQ(drivers::windlog::WindlogReader::open(folder / "a.windlog")->sessions().size(), 3U);
}

TEST(Recorder, CountsWhatCannotBeRecorded) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  EXPECT_FALSE(recorder.push(0, test::reading_at(1, -3.0)));
  EXPECT_FALSE(recorder.push(1, test::reading_at(1, 3.0)));
  EXPECT_EQ(recorder.status().lost, 2U);
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
    for (const wind::WindReading& reading : test::numbered_readings(10'000)) recorder.push(0, reading);
  }
  EXPECT_NE(last_report.find("10000 readings that could not be written"), std::string::npos) << last_report;
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 0U);
}

TEST(Recorder, ThatCannotWriteForLongHoldsABoundedNumberAndRefusesTheRest) {
  const test::TemporaryFolder folder;
  const test::FileSizeLimit full(150'000);
  Recorder recorder(folder / "a.windlog", info_of({{"mast", "", ""}}));
  const wind::WindReading reading = test::reading_at(1, 1.0);
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
    EXPECT_EQ(identity_of(link / "a.windlog").error(), std::errc::too_many_symbolic_link_levels);
    recorder.push(0, test::reading_at(1, 1.0));
    wait_for(recorder, [](const RecorderStatus& status) { return status.written == 1; });
  }
  EXPECT_EQ(reports, std::vector<std::string>{});
  EXPECT_EQ(test::read_all(folder / "real" / "a.windlog").size(), 1U);
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

  // The next start mends the file and appends.
  { Recorder recorder(file, info_of({{"mast", "", ""}})); }
  EXPECT_EQ(test::read_all(file).size(), logged.size());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace yuragi::daemon::recording
