#include "drivers/windlog/recording_parts.hpp"

#include <fstream>
#include <optional>

#include <gtest/gtest.h>

#include "drivers/windlog/recording_files.hpp"
#include "drivers/windlog/windlog_cursor.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using namespace std::chrono_literals;

const UtcTime kDay{std::chrono::milliseconds(test::kSampleUtc_ms)};  // 2018-07-20T14:00:00Z

TEST(RecordingParts, HaveTheMomentOfTheirBeginningInTheirName) {
  const std::filesystem::path part = part_name("/a/b/wall.windlog", kDay + 999ms);
  EXPECT_EQ(part, "/a/b/wall-20180720T140000Z.windlog");
  EXPECT_EQ(begin_of_part("/a/b/wall.windlog", part), kDay);
  for (const char* other : {"wall.windlog", "wall-20180720T140000Z.csv", "wal-20180720T140000Z.windlog",
                            "wall-2018720T140000Z.windlog", "wall-20180720T140000.windlog",
                            "wall-20180720T140000Z-copy.windlog", "wall-format1.windlog", "wall-.windlog"}) {
    EXPECT_FALSE(begin_of_part("/a/b/wall.windlog", other)) << other;
  }
}

TEST(RecordingParts, AreFoundInTheOrderOfTime) {
  const test::TemporaryFolder folder;
  const auto recording = folder / "wall.windlog";
  for (const auto later : {48h, 0h, 24h}) std::ofstream(part_name(recording, kDay + later)) << "x";
  std::ofstream(folder / "other-20180720T140000Z.windlog") << "x";
  std::filesystem::create_directory(part_name(recording, kDay + 72h));
  const auto parts = completed_parts(recording);
  ASSERT_EQ(parts.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(parts[i].begin, kDay + static_cast<int>(i) * 24h);
  EXPECT_TRUE(completed_parts("/nonexistent/wall.windlog").empty());
}

/// Readings of a day of the sample's, one a second.
std::vector<wind::Reading> readings_of_day(int day) {
  std::vector<wind::Reading> readings = test::numbered_readings(700);
  for (wind::Reading& reading : readings) {
    reading.time.mono += day * 24h;
    reading.time.utc += day * 24h;
  }
  return readings;
}

/// The same three days as a series of files, "wall.windlog", and as one file, "whole.windlog".
class RecordingOfParts : public testing::Test {
 protected:
  void SetUp() override {
    for (int day = 0; day < 3; ++day) {
      const std::string sensor = day == 1 ? "roof" : "mast";
      const auto part = day == 2 ? recording() : part_name(recording(), kDay + day * 24h);
      test::write_session(part, readings_of_day(day), sensor);
      test::write_session(folder_ / "whole.windlog", readings_of_day(day), sensor);
    }
  }

  std::filesystem::path recording() const { return folder_ / "wall.windlog"; }

  test::TemporaryFolder folder_;
};

TEST_F(RecordingOfParts, IsReadToItsEndAlthoughItsWriterCompletesTheLastFileMeanwhile) {
  auto reader = Reader::open(recording());
  ASSERT_TRUE(reader) << reader.error().message;
  ASSERT_FALSE(rename_recording(recording(), part_name(recording(), kDay + 48h)));
  test::write_session(recording(), readings_of_day(3), "roof");
  EXPECT_EQ(reader->configuration(3).value(), "[wind]\n");
  std::optional<LoggedReading> last;
  std::size_t count = 0;
  for (auto logged = reader->next(); logged && *logged; logged = reader->next(), ++count) last = **logged;
  EXPECT_EQ(count, 3U * 700U);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->reading.time.utc, readings_of_day(2).back().time.utc);
  EXPECT_EQ(reader->sensors()[last->sensor].name, "mast");
}

TEST_F(RecordingOfParts, IsReadAsOne) {
  auto parts = Reader::open(recording());
  auto whole = Reader::open(folder_ / "whole.windlog");
  ASSERT_TRUE(parts) << parts.error().message;
  EXPECT_EQ(parts->sessions().size(), 3U);
  EXPECT_EQ(parts->duration(), whole->duration());
  EXPECT_EQ(parts->configuration(2).value(), "[wind]\n");
  for (const Nanoseconds from : {0s, 30s, 86'400s, 86'430s, 172'869s}) {
    parts->seek(from);
    whole->seek(from);
    for (;;) {
      const auto expected = whole->next().value();
      const auto found = parts->next().value();
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (!expected) break;
      ASSERT_EQ(found->log_time, expected->log_time);
      test::expect_same(found->reading, expected->reading);
      ASSERT_EQ(parts->sensors()[found->sensor].name, whole->sensors()[expected->sensor].name);
    }
  }
  for (const auto moment : {kDay, kDay + 31s, kDay + 24h, kDay + 48h + 5s, kDay + 72h}) {
    EXPECT_EQ(parts->log_time_of(moment).value(), whole->log_time_of(moment).value());
  }
}

TEST_F(RecordingOfParts, OneThatIsDamagedIsNamedAndTheOthersAreRead) {
  const auto damaged = part_name(recording(), kDay + 24h);
  std::ofstream(damaged, std::ios::binary | std::ios::trunc) << std::string(4096, '\0');
  auto reader = Reader::open(recording());
  ASSERT_TRUE(reader) << reader.error().message;
  ASSERT_EQ(reader->damage().size(), 1U);
  const std::string sentence = reader->damage()[0];
  EXPECT_NE(sentence.find("wall-20180721T140000Z.windlog"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("from 2018-07-21T14:00:00Z on"), std::string::npos) << sentence;
  EXPECT_EQ(test::read_all(recording()).size(), 1400U);
  EXPECT_EQ(reader->log_time_of(kDay + 24h).value(), reader->log_time_of(kDay + 48h).value());
}

TEST_F(RecordingOfParts, TheRestOfOneThatIsDamagedInTheMiddleIsLeftOut) {
  const auto damaged = part_name(recording(), kDay + 24h);
  {
    // Pages of readings; the last page of readings, and that of the counts, stay.
    std::fstream file(damaged, std::ios::binary | std::ios::in | std::ios::out);
    constexpr std::streamoff kPage = 4096;
    const auto size = static_cast<std::streamoff>(std::filesystem::file_size(damaged));
    ASSERT_GT(size, 8 * kPage);
    file.seekp(size - 5 * kPage);
    file << std::string(3 * kPage, '\xff');
  }
  auto reader = Reader::open(recording());
  ASSERT_TRUE(reader) << reader.error().message;
  std::size_t of_roof = 0;
  std::size_t of_mast = 0;
  for (auto next = reader->next(); next && *next; next = reader->next()) {
    ++(reader->sensors()[(*next)->sensor].name == "roof" ? of_roof : of_mast);
  }
  EXPECT_EQ(of_mast, 1400U);
  EXPECT_LT(of_roof, 700U);
  ASSERT_EQ(reader->damage().size(), 1U);
  EXPECT_NE(reader->damage()[0].find("wall-20180721T140000Z.windlog"), std::string::npos) << reader->damage()[0];
  EXPECT_NE(reader->damage()[0].find("up to 2018-07-21T14:0"), std::string::npos) << reader->damage()[0];
}

TEST_F(RecordingOfParts, IsRefusedWhereAllAreDamaged) {
  for (const auto& part : completed_parts(recording())) std::ofstream(part.file, std::ios::trunc) << "no database";
  std::ofstream(recording(), std::ios::trunc) << "no database";
  EXPECT_FALSE(Reader::open(recording()));
}

TEST_F(RecordingOfParts, OneThatWasJustCreatedHoldsNothingYet) {
  std::ofstream(recording(), std::ios::trunc).flush();
  auto reader = Reader::open(recording());
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_TRUE(reader->damage().empty());
  EXPECT_EQ(test::read_all(recording()).size(), 1400U);
}

TEST_F(RecordingOfParts, IsReadWithoutTheFileThatWasWrittenLast) {
  std::filesystem::remove(recording());
  EXPECT_EQ(test::read_all(recording()).size(), 1400U);
}

TEST_F(RecordingOfParts, OneSensorIsReadThroughAllParts) {
  auto cursor = Cursor::open(recording(), "mast");
  ASSERT_TRUE(cursor) << cursor.error().message;
  std::size_t count = 0;
  for (auto logged = cursor->next(); logged && *logged; logged = cursor->next(), ++count) {
    EXPECT_EQ(cursor->sensor_of(**logged).name, "mast");
  }
  EXPECT_EQ(count, 1400U);
  EXPECT_EQ(Cursor::open(recording(), "roof")->last(), 24h + 69'900ms);
}

TEST_F(RecordingOfParts, ReadsOnAsTheLastPartGrows) {
  const auto readings = readings_of_day(3);
  auto writer = Writer::open(recording());
  ASSERT_TRUE(writer->begin_session({readings[0].time, "yuragi test", ""}));
  const auto sensor = writer->add_sensor("mast", "synthetic", "");
  ASSERT_TRUE(writer->append(*sensor, readings[0]));
  ASSERT_TRUE(writer->commit());
  auto reader = Reader::open(recording());
  while (reader->next()->has_value()) continue;
  ASSERT_TRUE(writer->append(*sensor, readings[1]));
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(reader->next()->value().log_time, 72h + 100ms);
}

}  // namespace
}  // namespace yuragi::drivers::windlog
