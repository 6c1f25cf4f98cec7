// Recordings that are damaged, made up, or where they cannot be locked.
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "drivers/windlog/format.hpp"
#include "drivers/windlog/windlog_playback.hpp"
#include "tests/drivers/windlog/hostile_recordings.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using test::numbered_readings;
using test::read_all;
using test::read_warily;
using test::reading_at;
using test::tamper;
using test::write_session;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

TEST(HostileWindlog, OfRandomBytesIsRefused) {
  const test::TemporaryFolder folder;
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    std::string bytes(random() % 8192, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    if (i % 2 == 0 && bytes.size() >= 16) bytes.replace(0, 16, std::string_view("SQLite format 3\0", 16));
    write_bytes(folder / "garbage.windlog", bytes);
    EXPECT_FALSE(Reader::open(folder / "garbage.windlog"));
    EXPECT_FALSE(Playback::open(folder / "garbage.windlog"));
  }
}

TEST(HostileWindlog, CutAtAnyLengthIsRefusedOrReadInPart) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "whole.windlog", test::numbered_readings(3000));
  const std::string whole = bytes_of(folder / "whole.windlog");
  std::size_t most = 0;
  for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 150) {
    write_bytes(folder / "cut.windlog", std::string_view(whole).substr(0, length));
    most = std::max(most, read_warily(folder / "cut.windlog"));
  }
  EXPECT_LE(most, 3000U);
}

TEST(HostileWindlog, WithAnyByteChangedIsRefusedOrReadInPart) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "whole.windlog", test::numbered_readings(500));
  const std::string whole = bytes_of(folder / "whole.windlog");
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    std::string changed = whole;
    for (int change = 0; change < 1 + i % 20; ++change)
      changed[random() % changed.size()] = static_cast<char>(random());
    write_bytes(folder / "changed.windlog", changed);
    read_warily(folder / "changed.windlog");
  }
  EXPECT_EQ(read_warily(folder / "whole.windlog"), 500U);
}

/// Replaces the table of the first sensor's readings by one that takes anything.
void loosen(const std::filesystem::path& file) {
  tamper(file,
         "CREATE TABLE loose (time_ns INTEGER PRIMARY KEY, clock_ns, speed_m_s, direction_deg, gust_m_s, quality);"
         "DROP VIEW reading; INSERT INTO loose SELECT * FROM reading_1; DROP TABLE reading_1;"
         "ALTER TABLE loose RENAME TO reading_1;");
}

TEST(HostileWindlog, RowsThatCannotBeReadingsArePassedOverAndCounted) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  test::write_session(file, {test::reading_at(1000, 1.0), test::reading_at(9000, 2.0)});
  loosen(file);
  std::vector<std::string> bad_rows = {
      "'today', 1.0, NULL, NULL, 0",  // clocks
      "NULL, 1.0, NULL, NULL, 0",
      "0.5, 1.0, NULL, NULL, 0",
      "9223372036854775807, 1.0, NULL, NULL, 0",
      "-9223372036854775808, 1.0, NULL, NULL, 0",
  };
  for (const char* values : test::kImpossibleValues) bad_rows.push_back(std::string("0, ") + values);
  std::int64_t time_ns = 1'000'000'000;  // between the two good ones
  for (const std::string& row : bad_rows) {
    tamper(file, "INSERT INTO reading_1 VALUES (" + std::to_string(++time_ns) + ", " + row + ")");
  }
  test::expect_speeds_1_and_2(file, bad_rows.size());
}

TEST(HostileWindlog, RowsAtTimesBeyondAllMeasureChangeNothing) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  test::write_session(file, {test::reading_at(1000, 1.0), test::reading_at(9000, 2.0)});
  for (const char* time_ns : {"-1", "-9223372036854775808", "9223372036854775807"}) {
    tamper(file, std::string("INSERT INTO reading_1 VALUES (") + time_ns + ", 0, 1.0, NULL, NULL, 0)");
  }
  EXPECT_EQ(read_warily(file), 2U);
  EXPECT_EQ(Reader::open(file)->duration(), std::chrono::seconds(8));
}

TEST(HostileWindlog, SessionsAtImpossibleTimesAreRefused) {
  const test::TemporaryFolder folder;
  for (const char* change : {"begin_ns = -1", "begin_ns = 9223372036854775807", "started_mono_ns = -1",
                             "started_utc_ns = 9223372036854775807"}) {
    const auto file = folder / "a.windlog";
    std::filesystem::remove(file);
    test::write_session(file, {test::reading_at(1000, 1.0)});
    tamper(file, std::string("UPDATE session SET ") + change);
    const auto reader = Reader::open(file);
    ASSERT_FALSE(reader) << change;
    EXPECT_NE(reader.error().message.find("session 1"), std::string::npos) << reader.error().message;
  }
}

TEST(HostileWindlog, ASensorOfNoSeriesOrOfAnImpossibleOneHasNoReadings) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  test::write_session(file, {test::reading_at(1000, 1.0)});
  tamper(file,
         "PRAGMA foreign_keys = OFF; INSERT INTO series (id, name) VALUES (-1, 'a'), (481, 'b');"
         "INSERT INTO sensor (session, series, driver, options) VALUES (1, -1, '', ''), (1, 481, '', ''), "
         "(1, 77, '', '')");
  EXPECT_EQ(read_warily(file), 1U);
  EXPECT_EQ(Reader::open(file)->sensors().size(), 1U);
}

TEST(HostileWindlog, AViewInPlaceOfATableIsNotRun) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  test::write_session(file, {test::reading_at(1000, 1.0)});
  tamper(file,
         "DROP VIEW reading; DROP TABLE reading_1; CREATE VIEW reading_1 AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL "
         "SELECT x + 1 FROM n) SELECT x AS time_ns, 0 AS clock_ns, 1.0 AS speed_m_s, NULL AS direction_deg, "
         "NULL AS gust_m_s, 0 AS quality FROM n");
  EXPECT_FALSE(Reader::open(file));
}

TEST(HostileWindlog, AFileThatLacksATableOrAColumnIsRefused) {
  const test::TemporaryFolder folder;
  for (const char* sql : {"DROP TABLE session", "DROP TABLE sensor", "DROP TABLE series", "DROP TABLE reading_1",
                          "ALTER TABLE reading_1 DROP COLUMN gust_m_s", "PRAGMA user_version = 0"}) {
    const auto file = folder / "a.windlog";
    std::filesystem::remove(file);
    test::write_session(file, {test::reading_at(1000, 1.0)});
    tamper(file, std::string("PRAGMA foreign_keys = OFF; DROP VIEW reading; ") + sql);
    EXPECT_FALSE(Reader::open(file)) << sql;
  }
}

/// Does something as a user who may not write to anything of root's; answers what it answered.
int as_nobody(const std::function<int()>& act) {
  const pid_t child = fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (geteuid() == 0 && setresuid(kNobody, kNobody, kNobody) != 0) _exit(100);
    _exit(act());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 101;
}

TEST(HostileWindlog, InAReadOnlyFolderIsReadIfItWasClosedAndRefusedInWordsIfNot) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "closed.windlog", test::numbered_readings(10));

  // One whose recorder was killed, as it lies on the disk.
  auto writer = Writer::open(folder / "live.windlog");
  ASSERT_TRUE(writer->begin_session({test::reading_at(0, 0).time, "yuragi test", ""}));
  ASSERT_TRUE(writer->append(*writer->add_sensor("mast", "", ""), test::reading_at(1, 1.0)));
  ASSERT_TRUE(writer->commit());
  std::filesystem::copy_file(folder / "live.windlog", folder / "killed.windlog");
  std::filesystem::copy_file(folder / "live.windlog-wal", folder / "killed.windlog-wal");
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    std::filesystem::permissions(entry.path(), std::filesystem::perms(0444));
  }
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));

  EXPECT_EQ(as_nobody([&] { return static_cast<int>(read_warily(folder / "closed.windlog")); }), 10);
  EXPECT_EQ(as_nobody([&] {
              const auto reader = Reader::open(folder / "killed.windlog");
              return !reader && reader.error().message.find("copy both") != std::string::npos ? 7 : 8;
            }),
            7);
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
}

}  // namespace
}  // namespace yuragi::drivers::windlog
