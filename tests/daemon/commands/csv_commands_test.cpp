// `yuragi import` and `yuragi export`, from command line to files.
#include <fstream>
#include <iterator>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::commands {

extern const commands::Command kImportCommand;
extern const commands::Command kExportCommand;

namespace {

using testing::HasSubstr;

struct Outcome {
  int code = 0;
  std::string error;
  std::string output;
};

/// Runs `yuragi ARGUMENTS` in this process.
Outcome yuragi(std::vector<std::string> arguments) {
  CLI::App app;
  kImportCommand.add(app);
  kExportCommand.add(app);
  std::reverse(arguments.begin(), arguments.end());
  Outcome outcome;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    outcome = {kExitUsage, error.what(), ""};
  } catch (const ExitError& error) {
    outcome = {error.code(), error.what(), ""};
  } catch (const FailureError& error) {
    outcome = {exit_code_of(error.kind()), error.what(), ""};
  }
  outcome.error += testing::internal::GetCapturedStderr();
  outcome.output = testing::internal::GetCapturedStdout();
  return outcome;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class CsvCommands : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  std::ptrdiff_t count_files() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()), std::filesystem::directory_iterator{});
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(CsvCommands, ExportThenImportGivesTheSameReadings) {
  // Two sensors, two sessions, a clock that jumps; every field there and not there; numbers of all lengths.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> speed(0.0, wind::kMaxPlausibleSpeed_m_s);
  std::uniform_real_distribution<double> direction(0.0, 360.0);
  for (int session = 0; session < 2; ++session) {
    auto writer = drivers::windlog::Writer::open(path("a.windlog"));
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->begin_session({test::at_ms(0, test::kSampleUtc_ms), "yuragi test", ""}));
    const auto mast = writer->add_sensor("mast, \"north\"", "modbus", "");
    const auto roof = writer->add_sensor("roof", "modbus", "");
    Nanoseconds mono(random() % 1'000'000'000);
    for (int i = 0; i < 500; ++i) {
      mono += Nanoseconds(random() % 3'000'000'000);
      wind::Reading reading;
      reading.time.mono = MonoTime(mono);
      reading.time.utc = UtcTime(std::chrono::milliseconds(test::kSampleUtc_ms)) + std::chrono::hours(session) + mono;
      if (i > 250) reading.time.utc -= std::chrono::seconds(40);
      reading.speed_m_s = speed(random);
      if (random() % 2 == 0) reading.direction_deg = direction(random);
      if (random() % 2 == 0) reading.gust_m_s = speed(random);
      reading.quality = static_cast<wind::ReadingQuality>(random() % 3);
      ASSERT_TRUE(writer->append(random() % 2 == 0 ? *mast : *roof, reading));
    }
  }

  EXPECT_EQ(yuragi({"export", path("a.windlog"), "-o", path("a.csv")}).code, 0);
  const Outcome imported = yuragi({"import", path("a.csv"), "-o", path("b.windlog")});
  EXPECT_EQ(imported.code, 0) << imported.error;
  EXPECT_THAT(imported.output, HasSubstr("1000 readings of 1000 rows, 0 left out"));

  const auto a = test::read_all(path("a.windlog"));
  const auto b = test::read_all(path("b.windlog"));
  const auto a_reader = drivers::windlog::Reader::open(path("a.windlog"));
  const auto b_reader = drivers::windlog::Reader::open(path("b.windlog"));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].log_time, b[i].log_time);
    EXPECT_EQ(a[i].reading.time.utc, b[i].reading.time.utc);
    EXPECT_EQ(a[i].reading.speed_m_s, b[i].reading.speed_m_s);
    EXPECT_EQ(a[i].reading.direction_deg, b[i].reading.direction_deg);
    EXPECT_EQ(a[i].reading.gust_m_s, b[i].reading.gust_m_s);
    EXPECT_EQ(a[i].reading.quality, b[i].reading.quality);
    EXPECT_EQ(a_reader->sensors()[a[i].sensor].name, b_reader->sensors()[b[i].sensor].name);
  }

  // And once more: the same text.
  EXPECT_EQ(yuragi({"export", path("b.windlog"), "-o", path("b.csv")}).code, 0);
  EXPECT_EQ(text_of(path("a.csv")), text_of(path("b.csv")));
}

TEST_F(CsvCommands, ExportWritesWhatItSays) {
  wind::Reading reading = test::reading_at(100, 6.1);
  reading.direction_deg = 187.5;
  test::write_session(path("a.windlog"), {test::reading_at(0, 0.1), reading});
  const Outcome outcome = yuragi({"export", path("a.windlog"), "-o", "-"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.output,
            "utc,time_s,sensor,speed_m_s,direction_deg,gust_m_s,quality\n"
            "2018-07-20T14:00:00.000000000Z,0.000000000,mast,0.1,,,good\n"
            "2018-07-20T14:00:00.100000000Z,0.100000000,mast,6.1,187.5,,good\n");
}

/// How many rows `yuragi export` writes of a part of a recording.
std::ptrdiff_t exported_rows(const std::string& recording, const std::vector<std::string>& part) {
  std::vector<std::string> arguments = {"export", recording, "-o", "-"};
  arguments.insert(arguments.end(), part.begin(), part.end());
  const Outcome outcome = yuragi(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  return std::count(outcome.output.begin(), outcome.output.end(), '\n') - 1;
}

TEST_F(CsvCommands, ExportTakesAPart) {
  test::write_session(path("a.windlog"), test::numbered_readings(100));
  const auto rows = [&](const std::vector<std::string>& part) { return exported_rows(path("a.windlog"), part); };
  EXPECT_EQ(rows({}), 100);
  EXPECT_EQ(rows({"--from", "2", "--to", "3"}), 10);
  EXPECT_EQ(rows({"--from", "2018-07-20T14:00:02Z", "--to", "2018-07-20T14:00:04Z"}), 20);
  EXPECT_EQ(rows({"--from", "2030-01-01"}), 0);
  EXPECT_EQ(rows({"--to", "2030-01-01"}), 100);
  EXPECT_EQ(yuragi({"export", path("a.windlog"), "-o", "-", "--from", "soon"}).code, kExitUsage);
}

TEST_F(CsvCommands, ExportBeginsSoLongBeforeTheEnd) {
  test::write_session(path("a.windlog"), test::numbered_readings(100));
  const auto rows = [&](const std::vector<std::string>& part) { return exported_rows(path("a.windlog"), part); };
  EXPECT_EQ(rows({"--since", "2s"}), 21) << "the last reading, and those of the two seconds before it";
  EXPECT_EQ(rows({"--since", "7d"}), 100);
  EXPECT_EQ(rows({"--since", "2018-07-20T14:00:02Z"}), 90);
  EXPECT_EQ(rows({"--since", "2018-07-20T14:00:02Z", "--until", "2018-07-20T14:00:04Z"}), 20);
  EXPECT_EQ(rows({"--since", "2s", "--until", "1s"}), 10);
  EXPECT_EQ(rows({"--since", "2030-01-01"}), 0);
  EXPECT_EQ(yuragi({"export", path("a.windlog"), "-o", "-", "--since", "soon"}).code, kExitUsage);
  EXPECT_EQ(yuragi({"export", path("a.windlog"), "-o", "-", "--since", "1h", "--from", "3"}).code, kExitUsage);
  EXPECT_EQ(yuragi({"export", path("a.windlog"), "-o", path("b.windlog"), "--since", "1h"}).code, kExitUsage);
}

TEST_F(CsvCommands, ExportWritesMeansOfBlocks) {
  std::vector<wind::Reading> readings;
  const auto add = [&readings](std::int64_t ms, double speed_m_s, std::optional<double> direction_deg,
                               std::optional<double> gust_m_s = std::nullopt) {
    readings.push_back(test::reading_at(ms, speed_m_s));
    readings.back().direction_deg = direction_deg;
    readings.back().gust_m_s = gust_m_s;
  };
  add(7'000, 2.0, 350.0, 3.5);  // from 14:00:07 on
  add(8'000, 2.0, 10.0);
  add(9'000, 5.0, std::nullopt);
  add(31'000, 3.0, 90.0);
  add(32'000, 3.0, 270.0);
  add(40'000, 0.0, 123.0);  // on the edge: of the next block
  test::write_session(path("a.windlog"), readings);
  const Outcome outcome = yuragi({"export", path("a.windlog"), "-o", "-", "--resample", "10"});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(outcome.output,
            "utc,time_s,sensor,speed_m_s,direction_deg,gust_m_s,count\n"
            "2018-07-20T14:00:00.000000000Z,-7.000000000,mast,3,0,5,3\n"
            "2018-07-20T14:00:10.000000000Z,3.000000000,mast,,,,0\n"
            "2018-07-20T14:00:20.000000000Z,13.000000000,mast,,,,0\n"
            "2018-07-20T14:00:30.000000000Z,23.000000000,mast,3,,3,2\n"
            "2018-07-20T14:00:40.000000000Z,33.000000000,mast,0,,0,1\n");
  EXPECT_THAT(outcome.error, HasSubstr("5 rows from 6 readings"));
}

TEST_F(CsvCommands, AClockThatLeaptByDecadesIsNoTableOfEmptyRows) {
  std::vector<wind::Reading> readings = {test::reading_at(0, 2.0)};
  test::write_session(path("a.windlog"), readings);
  readings[0].time.utc += std::chrono::hours(24 * 365 * 31);
  test::write_session(path("a.windlog"), readings);
  const Outcome refused = yuragi({"export", path("a.windlog"), "-o", "-", "--resample", "1s"});
  EXPECT_EQ(refused.code, kExitUsage);
  EXPECT_THAT(refused.error, HasSubstr("choose longer blocks"));
  EXPECT_EQ(yuragi({"export", path("a.windlog"), "-o", "-", "--resample", "10d"}).code, 0);
}

TEST_F(CsvCommands, ExportCopiesALiveRecordingAsOneFile) {
  auto writer = drivers::windlog::Writer::open(path("live.windlog"));
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, 0), "yuragi test", ""}));
  const auto sensor = writer->add_sensor("mast", "", "");
  ASSERT_TRUE(writer->append(*sensor, test::reading_at(1, 1.0)));
  ASSERT_TRUE(writer->commit());
  ASSERT_TRUE(writer->append(*sensor, test::reading_at(2, 2.0)));
  const std::ptrdiff_t before = count_files();

  const Outcome outcome = yuragi({"export", path("live.windlog"), "-o", path("copy.windlog")});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(count_files(), before + 1);
  EXPECT_EQ(test::read_all(path("copy.windlog")).size(), 1U) << "what was committed";
  EXPECT_TRUE(writer->commit()) << "the recorder was not disturbed";

  // The copy is a recording like any other.
  test::write_session(path("copy.windlog"), {test::reading_at(3, 3.0)});
  EXPECT_EQ(test::read_all(path("copy.windlog")).size(), 2U);
}

TEST_F(CsvCommands, RefuseToOverwriteUnlessForced) {
  write("a.csv", "time,speed\n0,1\n");
  write("b.windlog", "precious");
  EXPECT_EQ(yuragi({"import", path("a.csv"), "-o", path("b.windlog")}).code, kExitCannotCreate);
  EXPECT_EQ(text_of(path("b.windlog")), "precious");
  EXPECT_EQ(yuragi({"import", path("a.csv"), "-o", path("b.windlog"), "--force"}).code, 0);
  EXPECT_EQ(test::read_all(path("b.windlog")).size(), 1U);
  EXPECT_EQ(yuragi({"export", path("b.windlog"), "-o", path("a.csv")}).code, kExitCannotCreate);
  EXPECT_EQ(count_files(), 2);
}

TEST_F(CsvCommands, RefuseToOverwriteARecordingThatIsBeingWritten) {
  write("a.csv", "time,speed\n0,1\n");
  auto writer = drivers::windlog::Writer::open(path("live.windlog"));
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, 0), "yuragi test", ""}));
  ASSERT_TRUE(writer->commit());
  const Outcome outcome = yuragi({"import", path("a.csv"), "-o", path("live.windlog"), "--force"});
  EXPECT_EQ(outcome.code, kExitCannotCreate);
  EXPECT_THAT(outcome.error, HasSubstr("being recorded"));
}

TEST_F(CsvCommands, ImportTellsTheColumnsAndWhatItLeftOut) {
  write("a.csv", "time,u_ms,v_ms\n0,1,1\n1,x,1\n2,1,1\n");
  const Outcome outcome = yuragi({"import", path("a.csv"), "-o", path("a.windlog"), "--sensor", "sonic"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.output, HasSubstr("u from \"u_ms\" (m/s, toward east; by its name)"));
  EXPECT_THAT(outcome.output, HasSubstr("2 readings of 3 rows, 1 left out"));
  EXPECT_THAT(outcome.error, HasSubstr("a.csv:3: not a number in u: \"x\""));
  EXPECT_EQ(drivers::windlog::Reader::open(path("a.windlog"))->sensors()[0].name, "sonic");
}

TEST_F(CsvCommands, ImportThatFailsLeavesNothing) {
  write("none.csv", "time,speed\nx,1\ny,1\n");
  write("odd.csv", "a,b\n1,2\n");
  write("bad.csv", "time,speed\n0,1\n1,x\n");
  EXPECT_EQ(yuragi({"import", path("none.csv"), "-o", path("a.windlog")}).code, kExitDataError);
  EXPECT_EQ(yuragi({"import", path("odd.csv"), "-o", path("a.windlog")}).code, kExitDataError);
  EXPECT_EQ(yuragi({"import", path("bad.csv"), "-o", path("a.windlog"), "--strict"}).code, kExitDataError);
  EXPECT_EQ(yuragi({"import", path("absent.csv"), "-o", path("a.windlog")}).code, kExitNoInput);
  EXPECT_EQ(yuragi({"import", path("bad.csv"), "-o", path("nowhere/a.windlog")}).code, kExitCannotCreate);
  EXPECT_EQ(yuragi({"import", path("bad.csv"), "-o", path("a.windlog"), "--unit", "furlongs"}).code, kExitUsage);
  EXPECT_EQ(yuragi({"import", path("bad.csv"), "-o", path("a.windlog"), "--delimiter", "/"}).code, kExitUsage);
  EXPECT_EQ(count_files(), 3);
}

TEST_F(CsvCommands, ImportTakesItsOptions) {
  write("a.csv", "stamp|x;Avg;Vane\n1532095200000;36;4\n");
  const Outcome outcome = yuragi({"import",
                                  path("a.csv"),
                                  "-o",
                                  path("a.windlog"),
                                  "--time",
                                  "STAMP|X",
                                  "--speed",
                                  "avg",
                                  "--direction",
                                  "vane",
                                  "--unit",
                                  "km/h",
                                  "--time-format",
                                  "unix-ms",
                                  "--direction-unit",
                                  "point16",
                                  "--direction-convention",
                                  "toward",
                                  "--delimiter",
                                  ";"});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  const auto logged = test::read_all(path("a.windlog"));
  ASSERT_EQ(logged.size(), 1U);
  EXPECT_DOUBLE_EQ(logged[0].reading.speed_m_s, 10.0);
  EXPECT_EQ(logged[0].reading.direction_deg, 270.0);
  EXPECT_EQ(logged[0].reading.time.utc, UtcTime(std::chrono::milliseconds(test::kSampleUtc_ms)));
}

TEST_F(CsvCommands, ImportTakesAFileWithoutAHeaderAndOneStationOfSeveral) {
  write("a.csv", "a;20.7.2018 16:00;7;36;90\nb;20.7.2018 16:00;7;72;90\na;20.7.2018 16:10;99;18;270\n");
  const Outcome outcome =
      yuragi({"import", path("a.csv"), "-o", path("a.windlog"), "--header", "station,time,,speed,dir", "--where",
              "station=a", "--unit", "km/h", "--zone", "Europe/Berlin"});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  const auto logged = test::read_all(path("a.windlog"));
  ASSERT_EQ(logged.size(), 2U);
  EXPECT_DOUBLE_EQ(logged[0].reading.speed_m_s, 10.0);
  EXPECT_EQ(logged[0].reading.time.utc, UtcTime(std::chrono::milliseconds(test::kSampleUtc_ms)));
  EXPECT_EQ(logged[1].reading.direction_deg, 270.0);
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--zone", "Mars/Olympus"},
                                                {"--where", "station"},
                                                {"--gust-unit", "furlongs"},
                                                {"--start", "noon"}}) {
    std::vector<std::string> arguments = {"import", path("a.csv"), "-o", path("b.windlog")};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    EXPECT_EQ(yuragi(arguments).code, kExitUsage) << wrong[0];
  }
}

TEST_F(CsvCommands, ADryRunShowsWhatWouldBeWritten) {
  write("a.csv", "time,speed_ms\n2024-01-01 10:00,1\n2024-01-01 10:10,2\n2024-01-01 10:20,x\n");
  const Outcome outcome = yuragi({"import", path("a.csv"), "--dry-run"});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_THAT(outcome.output,
              testing::AllOf(HasSubstr("from 2024-01-01T10:00:00.000Z to 2024-01-01T10:10:00.000Z"),
                             HasSubstr("a reading every 10 min"), HasSubstr("mean 1.50 m/s, strongest 2.00 m/s"),
                             HasSubstr("nothing was written: 2 readings of 3 rows, 1 left out")));
  EXPECT_THAT(outcome.error, HasSubstr("left out: 1 row: not a number in speed"));
  EXPECT_EQ(yuragi({"import", path("a.csv")}).code, kExitUsage) << "neither --output nor --dry-run";
}

TEST_F(CsvCommands, WhatIsHardlyAWindIsWrittenOnlyIfForced) {
  std::string text = "time_s,speed_ms\n";
  for (int i = 0; i < 50; ++i) text += std::to_string(i) + "," + (i % 2 == 0 ? "50" : "1") + "\n";
  write("a.csv", text);
  const Outcome refused = yuragi({"import", path("a.csv"), "-o", path("a.windlog")});
  EXPECT_EQ(refused.code, kExitDataError);
  EXPECT_THAT(refused.error, testing::AllOf(HasSubstr("implausible: in 100 % of the steps"), HasSubstr("--force")));
  EXPECT_FALSE(std::filesystem::exists(path("a.windlog")));
  EXPECT_EQ(yuragi({"import", path("a.csv"), "-o", path("a.windlog"), "--force"}).code, 0);
  EXPECT_EQ(test::read_all(path("a.windlog")).size(), 50U);
}

TEST_F(CsvCommands, ExportRefusesWhatIsNoRecording) {
  write("a.txt", "hello");
  EXPECT_EQ(yuragi({"export", path("a.txt"), "-o", "-"}).code, kExitDataError);
  EXPECT_EQ(yuragi({"export", path("absent.windlog"), "-o", "-"}).code, kExitNoInput);
  EXPECT_EQ(count_files(), 1);
}

}  // namespace
}  // namespace yuragi::daemon::commands
