#include "drivers/windlog/verify_recording.hpp"

#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "drivers/windlog/recording_files.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kReadings = 600;  // of each file: a minute

class VerifyRecording : public testing::Test {
 protected:
  /// Three files of a series, each of a minute, one after the other without a pause.
  void write_series() {
    for (std::size_t part = 0; part < 3; ++part) {
      auto writer = Writer::open(file_);
      ASSERT_TRUE(writer);
      const auto begin_ms = static_cast<std::int64_t>(60'000 * part);
      const Instant started = test::at_ms(begin_ms, test::kSampleUtc_ms + begin_ms);
      ASSERT_TRUE(writer->begin_session({started, "yuragi test", "[wind]\n"}));
      const auto sensor = writer->add_sensor("mast", "synthetic", "");
      ASSERT_TRUE(sensor);
      if (part > 0) {
        ASSERT_TRUE(writer->set_previous_part(completed_parts(file_).back().begin));
      }
      for (std::size_t i = 0; i < kReadings; ++i) {
        auto reading =
            test::reading_at(begin_ms + 100 * static_cast<std::int64_t>(i), 3.0 + 0.01 * static_cast<double>(i));
        if (i % 2 == 0) reading.direction_deg = 0.25 * static_cast<double>(i);
        ASSERT_TRUE(writer->append(*sensor, reading));
      }
      ASSERT_TRUE(writer->close());
      if (part < 2) {
        ASSERT_FALSE(rename_recording(file_, part_name(file_, started.utc)));
      }
    }
  }

  Verification verified(Nanoseconds max_gap = 60s) const { return verify_recording(file_, max_gap).value(); }

  std::filesystem::path part(std::size_t index) const { return completed_parts(file_).at(index).file; }

  static void execute(const std::filesystem::path& file, const char* sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
    sqlite3_close(database);
  }

  /// One finding in the second file, with these words, and none in the others.
  void expect_only_second_is_damaged(const std::string& words) const {
    const Verification found = verified();
    EXPECT_FALSE(found.is_sound());
    ASSERT_EQ(found.files.size(), 3U);
    EXPECT_TRUE(found.files[0].damage.empty());
    EXPECT_TRUE(found.files[2].damage.empty());
    std::string all;
    for (const std::string& sentence : found.files[1].damage) all += sentence + "\n";
    EXPECT_NE(all.find(words), std::string::npos) << all;
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "wall.windlog";
};

TEST_F(VerifyRecording, FindsNothingWrongWithASeriesAsItWasWritten) {
  write_series();
  const Verification found = verified();
  EXPECT_TRUE(found.is_sound());
  EXPECT_TRUE(found.gaps.empty());
  ASSERT_EQ(found.files.size(), 3U);
  for (const VerifiedFile& file : found.files) {
    EXPECT_TRUE(file.damage.empty()) << file.damage.front();
    EXPECT_EQ(file.readings, kReadings);
    EXPECT_EQ(file.sessions, 1U);
    EXPECT_EQ(file.sessions_without_count, 0U);
  }
  EXPECT_EQ(found.files[1].first, test::at_ms(0, test::kSampleUtc_ms + 60'000).utc);
  EXPECT_EQ(found.files[2].file, file_);
}

/// Each byte of the row in the middle of the first pages that are full of readings.
TEST_F(VerifyRecording, FindsAByteThatWasFlippedInTheMiddleOfAPageOfReadings) {
  write_series();
  const std::filesystem::path damaged = part(1);
  std::ifstream in(damaged, std::ios::binary);
  const std::string sound((std::istreambuf_iterator<char>(in)), {});
  constexpr std::size_t kPageBytes = 4096;
  std::size_t pages_of_readings = 0;
  for (std::size_t middle = kPageBytes / 2; middle < sound.size(); middle += kPageBytes) {
    // A leaf of a table that is filled by readings: SQLite's file format, "b-tree pages".
    const std::size_t page = middle - kPageBytes / 2;
    const auto cells = 256U * static_cast<unsigned char>(sound[page + 3]) + static_cast<unsigned char>(sound[page + 4]);
    if (sound[page] != 0x0d || cells < 50 || pages_of_readings == 2) continue;
    ++pages_of_readings;
    for (std::size_t byte = middle; byte < middle + 40; ++byte) {
      std::string flipped = sound;
      flipped[byte] = static_cast<char>(flipped[byte] ^ 0x10);
      std::ofstream(damaged, std::ios::binary) << flipped;
      const Verification found = verified();
      EXPECT_FALSE(found.is_sound()) << "byte " << byte;
    }
  }
  EXPECT_EQ(pages_of_readings, 2U);
}

TEST_F(VerifyRecording, FindsReadingsThatWereDeletedOrChangedSinceTheirSessionWasClosed) {
  write_series();
  execute(part(1), "DELETE FROM reading_1 WHERE time_ns IN (SELECT time_ns FROM reading_1 LIMIT 3 OFFSET 100)");
  expect_only_second_is_damaged("session 1, sensor mast: 597 readings of the 600 that were written");
  execute(part(1), "DELETE FROM reading_1");
  expect_only_second_is_damaged("session 1, sensor mast: 0 readings of the 600 that were written");
}

TEST_F(VerifyRecording, FindsAReadingThatWasChanged) {
  write_series();
  execute(part(1), "UPDATE reading_1 SET speed_m_s = speed_m_s + 1e-9 WHERE time_ns = 0");
  expect_only_second_is_damaged("session 1, sensor mast: readings were changed");
}

TEST_F(VerifyRecording, FindsReadingsThatHaveLostTheirSensorOrSession) {
  write_series();
  execute(part(1), "DELETE FROM sensor");
  expect_only_second_is_damaged("600 readings without a session or sensor");
  execute(part(1), "DELETE FROM session_count; DELETE FROM session");
  expect_only_second_is_damaged("600 readings without a session or sensor");
}

TEST_F(VerifyRecording, FindsRowsThatCannotBeReadings) {
  write_series();
  execute(part(1), "UPDATE reading_1 SET speed_m_s = 1e6 WHERE time_ns = 0");
  expect_only_second_is_damaged("1 row that cannot be readings");
}

TEST_F(VerifyRecording, FindsAFileThatIsMissingInTheMiddleAndNotOneThatWasDeletedAtTheBeginning) {
  write_series();
  const std::filesystem::path first = part(0);
  const std::filesystem::path second = part(1);
  std::filesystem::rename(first, folder_ / "away");
  EXPECT_TRUE(verified().is_sound());
  std::filesystem::rename(folder_ / "away", first);
  std::filesystem::remove(second);
  const Verification found = verified(30s);
  EXPECT_FALSE(found.is_sound());
  EXPECT_EQ(found.missing, std::vector{second});
  ASSERT_EQ(found.gaps.size(), 1U);
  EXPECT_EQ(found.gaps[0].length, 60'100ms);
  EXPECT_EQ(found.gaps[0].sensor, "mast");
}

TEST_F(VerifyRecording, HasNoCountOfASessionThatWasNotClosed) {
  auto writer = Writer::open(file_);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, test::kSampleUtc_ms), "yuragi test", ""}));
  const auto sensor = writer->add_sensor("mast", "synthetic", "");
  ASSERT_TRUE(sensor);
  for (const auto& reading : test::numbered_readings(20)) ASSERT_TRUE(writer->append(*sensor, reading));
  ASSERT_TRUE(writer->commit());
  ASSERT_TRUE(writer->append(*sensor, test::reading_at(9000, 1.0)));
  const Verification live = verified();
  EXPECT_TRUE(live.is_sound());
  ASSERT_EQ(live.files.size(), 1U);
  EXPECT_EQ(live.files[0].readings, 20U);
  EXPECT_EQ(live.files[0].sessions_without_count, 1U);
  ASSERT_TRUE(writer->close());
  EXPECT_EQ(verified().files[0].sessions_without_count, 0U);
}

TEST_F(VerifyRecording, ReadsARecordingOfVersion1AndNamesWhatIsNone) {
  EXPECT_EQ(verify_recording(file_, 60s).error().kind, FailureKind::kNoInput);
  std::filesystem::copy_file(test::source_path("tests/drivers/windlog/format1.windlog"), file_);
  EXPECT_TRUE(verified().is_sound());
  EXPECT_GT(verified().files[0].readings, 0U);
  std::ofstream(file_) << "no recording";
  EXPECT_FALSE(verified().is_sound());
}

}  // namespace
}  // namespace yuragi::drivers::windlog
