#include "daemon/recording/clock_judge.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/recording/clock_doubt_file.hpp"
#include "daemon/recording/clock_synchronization.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::recording {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr Nanoseconds kDay = std::chrono::days(1);
const UtcTime kNoon = UtcTime(std::chrono::sys_days(std::chrono::year(2026) / 11 / 23)) + 12h;

/// A moment of a run that began at noon, by a clock that is ahead.
Instant after(Nanoseconds running, Nanoseconds ahead = 0ns) {
  return {MonoTime(1min + running), kNoon + running + ahead};
}

bool is_start_doubted(Nanoseconds after_newest) {
  ClockJudge judge(kNoon - after_newest, std::nullopt);
  judge.look(after(0s), false);
  return judge.doubt().has_value();
}

TEST(ClockJudge, DoubtsAStartBeforeTheNewestTimeOrLongAfterIt) {
  EXPECT_FALSE(is_start_doubted(0s));
  EXPECT_FALSE(is_start_doubted(-1h)) << "a step, as synchronization makes";
  EXPECT_TRUE(is_start_doubted(-1h - 1s));
  EXPECT_TRUE(is_start_doubted(-365 * kDay));
  EXPECT_FALSE(is_start_doubted(30 * kDay));
  EXPECT_TRUE(is_start_doubted(30 * kDay + 1s));
  ClockJudge of_nothing;
  of_nothing.look(after(0s), false);
  EXPECT_FALSE(of_nothing.doubt());
}

bool is_jump_doubted(Nanoseconds jump) {
  ClockJudge judge(kNoon, std::nullopt);
  judge.look(after(0s), false);
  judge.look(after(40 * kDay), false);
  EXPECT_FALSE(judge.doubt()) << "a long silence is no jump";
  judge.look(after(40 * kDay + 1s, jump), false);
  return judge.doubt().has_value();
}

TEST(ClockJudge, DoubtsAJumpOfMoreThanAnHourEitherWay) {
  EXPECT_FALSE(is_jump_doubted(1h));
  EXPECT_FALSE(is_jump_doubted(-1h));
  EXPECT_TRUE(is_jump_doubted(1h + 1s));
  EXPECT_TRUE(is_jump_doubted(-1h - 1s));
  EXPECT_TRUE(is_jump_doubted(400 * kDay));
}

TEST(ClockJudge, IgnoresWhatArrivesLate) {
  ClockJudge judge(kNoon, std::nullopt);
  judge.look(after(10s), false);
  judge.look(after(9s, 2h), false);
  EXPECT_FALSE(judge.doubt());
}

TEST(ClockJudge, DoubtsFor24HoursOfRunningOverAnyNumberOfStarts) {
  std::optional<ClockDoubt> doubt;
  for (int start = 0; start < 4; ++start) {
    // Switched off for the night: ten hours on the wall's clock, and another monotonic time.
    ClockJudge judge(kNoon + (start == 0 ? 400 * kDay : start * kDay - 14h), doubt);
    for (int hour = 0; hour < 7; ++hour) {
      judge.look(after(hour * 1h, start * kDay), false);
      EXPECT_EQ(judge.doubt().has_value(), start * 6 + hour < 24) << "start " << start << ", hour " << hour;
    }
    doubt = judge.doubt();
  }
}

TEST(ClockJudge, DoubtsAnewAfterAnotherJump) {
  ClockJudge judge(kNoon, std::nullopt);
  judge.look(after(0s), false);
  judge.look(after(1s, 2h), false);
  judge.look(after(23h, 2h), false);
  judge.look(after(23h + 1s, 0s), false);
  judge.look(after(25h), false);
  ASSERT_TRUE(judge.doubt());
  EXPECT_EQ(judge.doubt()->running, 2h - 1s);
  judge.look(after(47h + 1s), false);
  EXPECT_FALSE(judge.doubt());
}

TEST(ClockJudge, BelievesASynchronizedClock) {
  ClockJudge judge(kNoon + kDay, std::nullopt);
  judge.look(after(0s), false);
  EXPECT_TRUE(judge.doubt());
  judge.look(after(1s), true);
  EXPECT_FALSE(judge.doubt());
}

TEST(ClockJudge, SaysSinceWhenAndWhy) {
  ClockDoubt doubt{.since = std::chrono::floor<std::chrono::seconds>(kNoon), .ahead_s = 400 * 86'400LL, .running = 5h};
  EXPECT_EQ(
      text_of(doubt),
      "the clock may be wrong since 2026-11-23T12:00:00Z: it jumped ahead by 400 days; recordings are not deleted "
      "by age until it has run for another 19 h or is synchronized");
  doubt.ahead_s = -7200;
  EXPECT_THAT(text_of(doubt), HasSubstr(": it jumped back by 2 h;"));
  doubt.is_at_start = true;
  EXPECT_THAT(text_of(doubt), HasSubstr(": a start was 2 h before the newest reading;"));
  doubt.ahead_s = 31 * 86'400LL;
  EXPECT_THAT(text_of(doubt), HasSubstr(": a start was 31 days after the newest reading;"));
}

TEST(ClockDoubtFile, KeepsADoubtAndNothingElse) {
  const test::TemporaryFolder folder;
  const auto file = clock_doubt_file(folder / "a.windlog");
  EXPECT_FALSE(read_clock_doubt(file));
  const ClockDoubt doubt{.since = std::chrono::floor<std::chrono::seconds>(kNoon),
                         .is_at_start = true,
                         .ahead_s = -3601,
                         .running = 7h + 1s};
  ASSERT_TRUE(write_clock_doubt(file, doubt));
  const auto read = read_clock_doubt(file);
  ASSERT_TRUE(read);
  EXPECT_EQ(text_of(*read), text_of(doubt));
  EXPECT_EQ(read->running, doubt.running);
  ASSERT_TRUE(write_clock_doubt(file, std::nullopt));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_FALSE(write_clock_doubt(folder / "none" / "a.windlog-clock", doubt));
}

TEST(ClockDoubtFile, IsNotBelievedIfItIsDamaged) {
  const test::TemporaryFolder folder;
  for (const char* text : {"", "1 1 1", "x", "1 2 1 1", "1 1 1 -1", "1 1 1 86400", "9223372036854775807 1 1 1",
                           "1 1 -9223372036854775807 1", "99999999999999999999 1 1 1"}) {
    std::ofstream(folder / "a") << text;
    EXPECT_FALSE(read_clock_doubt(folder / "a")) << text;
  }
  EXPECT_FALSE(read_clock_doubt(folder.path())) << "a folder";
}

TEST(ClockSynchronization, IsKnownForAnHourAfterTheFileWasTouched) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(is_synchronized(folder / "synchronized", kNoon));
  std::ofstream(folder / "synchronized").flush();
  std::filesystem::last_write_time(folder / "synchronized", std::chrono::file_clock::from_sys(kNoon));
  EXPECT_TRUE(is_synchronized(folder / "synchronized", kNoon));
  EXPECT_TRUE(is_synchronized(folder / "synchronized", kNoon + 1h));
  EXPECT_TRUE(is_synchronized(folder / "synchronized", kNoon - 1s)) << "what is judged now may have waited";
  EXPECT_FALSE(is_synchronized(folder / "synchronized", kNoon + 1h + 1s)) << "perhaps the clock has jumped since";
  EXPECT_FALSE(is_synchronized(folder / "synchronized", kNoon - 2h));
}

}  // namespace
}  // namespace yuragi::daemon::recording
