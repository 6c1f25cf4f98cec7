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
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using test::numbered_readings;
using test::read_all;
using test::reading_at;
using test::write_session;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Changes a recording behind its back, as the sqlite3 program would.
void tamper(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &connection), SQLITE_OK);
  char* message = nullptr;
  EXPECT_EQ(sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, &message), SQLITE_OK) << message;
  sqlite3_free(message);
  sqlite3_close(connection);
}

/// Replaces the table of readings by one that takes anything.
void loosen(const std::filesystem::path& file) {
  tamper(file,
         "CREATE TABLE loose (session, sensor, utc_ns, mono_ns, speed_m_s, direction_deg, gust_m_s, quality);"
         "INSERT INTO loose SELECT * FROM reading; DROP TABLE reading; ALTER TABLE loose RENAME TO reading;");
}

/// Reads what can be read; whatever comes out is a reading, in order. Answers how many there were.
std::size_t read_warily(const std::filesystem::path& file) {
  auto reader = WindlogReader::open(file);
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

TEST(HostileWindlog, OfRandomBytesIsRefused) {
  const test::TemporaryFolder folder;
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    std::string bytes(random() % 8192, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    if (i % 2 == 0 && bytes.size() >= 16) bytes.replace(0, 16, std::string_view("SQLite format 3\0", 16));
    write_bytes(folder / "garbage.windlog", bytes);
    EXPECT_FALSE(WindlogReader::open(folder / "garbage.windlog"));
    EXPECT_FALSE(WindlogPlayback::open(folder / "garbage.windlog"));
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

TEST(HostileWindlog, RowsThatCannotBeReadingsArePassedOverAndCounted) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  test::write_session(file, {test::reading_at(1000, 1.0), test::reading_at(9000, 2.0)});
  loosen(file);
  const std::vector<std::string> bad_rows = {
      "1, 1, 5, 2000, 'fast', NULL, NULL, 0",  // types
      "1, 1, 5, 2000, NULL, NULL, NULL, 0",
      "1, 1, 5, 2000, x'00', NULL, NULL, 0",
      "1, 1, 5, 2000, 1.0, 'west', NULL, 0",
      "1, 1, 5, 2000, 1.0, NULL, 'none', 0",
      "1, 1, 5, 2000, 1.0, NULL, NULL, 'good'",
      "1, 1, 5, 2000, 1.0, NULL, NULL, NULL",
      "1, 1, 'today', 2000, 1.0, NULL, NULL, 0",
      "1, 1, NULL, 2000, 1.0, NULL, NULL, 0",
      "1, 1, 5, 2000.5e6, 1.0, NULL, NULL, 0",
      "1, NULL, 5, 2000, 1.0, NULL, NULL, 0",
      "1, 1, 5, 2000, -1.0, NULL, NULL, 0",  // values
      "1, 1, 5, 2000, 121.0, NULL, NULL, 0",
      "1, 1, 5, 2000, 9e999, NULL, NULL, 0",
      "1, 1, 5, 2000, 1.0, 360.0, NULL, 0",
      "1, 1, 5, 2000, 1.0, NULL, -0.1, 0",
      "1, 1, 5, 2000, 1.0, NULL, NULL, 3",
      "1, 1, 5, 2000, 1.0, NULL, NULL, -1",
      "1, 77, 5, 2000, 1.0, NULL, NULL, 0",                   // nobody's
      "1, 1, 9223372036854775807, 2000, 1.0, NULL, NULL, 0",  // times
      "1, 1, -9223372036854775808, 2000, 1.0, NULL, NULL, 0",
  };
  for (const std::string& row : bad_rows) {
    // Between the two good ones.
    std::string moved = row;
    if (const auto at = moved.find(" 2000,"); at != std::string::npos) moved.replace(at, 6, " 2000000000,");
    tamper(file, "INSERT INTO reading VALUES (" + moved + ")");
  }
  auto reader = WindlogReader::open(file);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->next()->value().reading.speed_m_s, 1.0);
  EXPECT_EQ(reader->next()->value().reading.speed_m_s, 2.0);
  EXPECT_FALSE(reader->next()->has_value());
  EXPECT_EQ(reader->skipped(), bad_rows.size());
}

TEST(HostileWindlog, RowsAtTimesBeyondAllMeasureChangeNothing) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  test::write_session(file, {test::reading_at(1000, 1.0), test::reading_at(9000, 2.0)});
  loosen(file);
  for (const char* mono_ns : {"-1", "-9223372036854775808", "9223372036854775807", "'noon'", "NULL"}) {
    tamper(file, std::string("INSERT INTO reading VALUES (1, 1, 5, ") + mono_ns + ", 1.0, NULL, NULL, 0)");
  }
  EXPECT_EQ(read_warily(file), 2U);
  EXPECT_EQ(WindlogReader::open(file)->duration(), std::chrono::seconds(8));
}

TEST(HostileWindlog, SessionsWhoseTimesAddUpToTooMuchAreRefused) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  wind::WindReading last = test::reading_at(0, 1.0);
  last.time.mono = MonoTime(Nanoseconds(kMaxTime_ns));
  for (int i = 0; i < 3; ++i) test::write_session(file, {test::reading_at(0, 1.0), last});
  const auto reader = WindlogReader::open(file);
  ASSERT_FALSE(reader);
  EXPECT_NE(reader.error().message.find("session 2"), std::string::npos) << reader.error().message;
}

TEST(HostileWindlog, AViewInPlaceOfATableIsNotRun) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  test::write_session(file, {test::reading_at(1000, 1.0)});
  tamper(file,
         "DROP TABLE reading; CREATE VIEW reading AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) "
         "SELECT 1 AS session, 1 AS sensor, x AS utc_ns, x AS mono_ns, 1.0 AS speed_m_s, NULL AS direction_deg, "
         "NULL AS gust_m_s, 0 AS quality FROM n");
  EXPECT_FALSE(WindlogReader::open(file));
}

TEST(HostileWindlog, AFileThatLacksATableOrAColumnIsRefused) {
  const test::TemporaryFolder folder;
  for (const char* sql : {"DROP TABLE session", "DROP TABLE sensor", "DROP TABLE reading",
                          "ALTER TABLE reading DROP COLUMN gust_m_s", "PRAGMA user_version = 0"}) {
    const auto file = folder / "a.windlog";
    std::filesystem::remove(file);
    test::write_session(file, {test::reading_at(1000, 1.0)});
    tamper(file, std::string("PRAGMA foreign_keys = OFF; ") + sql);
    EXPECT_FALSE(WindlogReader::open(file)) << sql;
  }
}

TEST(HostileWindlog, OfARecordingWithoutItsIndexIsReadAllTheSame) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  test::write_session(file, test::numbered_readings(2000));
  tamper(file, "DROP INDEX reading_by_time");
  EXPECT_EQ(test::read_all(file).size(), 2000U);
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
  auto writer = WindlogWriter::open(folder / "live.windlog");
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
              const auto reader = WindlogReader::open(folder / "killed.windlog");
              return !reader && reader.error().message.find("copy both") != std::string::npos ? 7 : 8;
            }),
            7);
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
}

}  // namespace
}  // namespace yuragi::drivers::windlog
