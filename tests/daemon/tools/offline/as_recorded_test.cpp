// A day is replayed as it was: with what the recording's own configuration says.
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/sensing/recorded_installation.hpp"
#include "daemon/tools/offline/lockstep_replay.hpp"
#include "tests/daemon/tools/offline/recorded_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::tools::offline {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

sensing::RecordedInstallation installation_in(const std::filesystem::path& file, const std::string& start = "") {
  auto installation = sensing::recorded_installation(file, {.playback = {.start = start}});
  EXPECT_TRUE(installation) << (installation ? "" : installation.error().message);
  return installation ? std::move(*installation) : sensing::RecordedInstallation{};
}

LockstepResult replay(const std::filesystem::path& file, const std::string& start = "", double duration_s = 0.0) {
  const auto result = replay_in_lockstep(installation_in(file, start), 0.0, duration_s, {});
  EXPECT_TRUE(result) << (result ? "" : result.error().message);
  return result ? *result : LockstepResult{};
}

class AsRecorded : public ::testing::Test {
 protected:
  /// Records a Friday noon of three sensors with this configuration.
  void record(const std::string& text, double duration_s = 60.0) {
    record_session(file_, kFridayNoon, duration_s, recorded_text(text), three_winds());
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "wall.windlog";
};

// A recording that version 0.2.0 wrote, of 1120 s from kFridayNoon on with the winds of three_winds(4.0), but for one
// spike of "mast" and six times the wind for "yard", which is outvoted in the end; it closes at 14:18. This hash is of
// every later version, too; it changed when WindTurbulence began to keep running sums, which round otherwise, when
// the waves over a meadow began to run at the speed that follows from its height, when "mast" and "roof" began to
// be levelled, and when gusts got fronts and came to places downwind on time.
TEST(KeptInstallation, IsReplayedWithTheSamePosesInEveryVersion) {
  const auto kept = std::filesystem::path(__FILE__).parent_path() / "as_recorded.windlog";
  const LockstepResult first = replay(kept);
  EXPECT_EQ(first.readings, 840U);
  EXPECT_EQ(first.pose_hash, replay(kept).pose_hash);
  EXPECT_EQ(fmt::format("{:016x}", first.pose_hash), "cd7150d72b33f110");
}

TEST_F(AsRecorded, EachSensorPlaysByItsNameWithItsCalibration) {
  record(installation_text());
  const sensing::RecordedInstallation installation = installation_in(file_);
  EXPECT_EQ(installation.begin, kFridayNoon);
  EXPECT_THAT(installation.remarks, IsEmpty());
  const LockstepResult result = replay(file_);
  EXPECT_EQ(result.readings, 180U);
  // Were the gain of one half not applied, it would be 7 m/s.
  EXPECT_NEAR(result.wind_mean_m_s, 5.4, 0.3);
}

TEST_F(AsRecorded, TheRecordingDecidesNeitherWhereItListensNorWhatItRuns) {
  record(
      "[stream]\nlisten = \"0.0.0.0:7410\"\ncontrol = \"anywhere\"\n[http]\nlisten = \"0.0.0.0:7480\"\n"
      "token_file = \"/etc/shadow\"\n[[alert]]\nname = \"a\"\ncommand = \"touch /tmp/alerted\"\n" +
      installation_text());
  const sensing::RecordedInstallation installation = installation_in(file_);
  EXPECT_EQ(installation.config.stream.listen, "127.0.0.1:7410");
  EXPECT_EQ(installation.config.stream.control, settings::ControlPermission::kLoopback);
  EXPECT_EQ(installation.config.http.listen, "");
  EXPECT_EQ(installation.config.http.token_file, "");
  EXPECT_THAT(installation.config.alerts, IsEmpty());
  EXPECT_THAT(installation.remarks, ElementsAre(HasSubstr("[stream] listen and control are not used"),
                                                HasSubstr("[http] is not used"), HasSubstr("alerts are not used")));
}

TEST_F(AsRecorded, TheRecordingPublishesNothing) {
  record("[mqtt]\nhost = \"127.0.0.1\"\ncommands = true\n[[osc]]\n" + installation_text());
  const sensing::RecordedInstallation installation = installation_in(file_);
  EXPECT_EQ(installation.config.feeds, settings::feeds::Config());
  EXPECT_EQ(installation.config.by_name.at("mqtt").all(), settings::default_config().by_name.at("mqtt").all());
  EXPECT_THAT(installation.remarks, testing::Contains(HasSubstr("feeds to other programs are not used")));
}

TEST_F(AsRecorded, TheRecordedClockOpensAndCloses) {
  record(installation_text("hours = \"10:00-15:00\"\nzone = \"Europe/Berlin\"\nfade = 5\n"));
  EXPECT_GT(replay(file_).wind_mean_m_s, 4.0) << "14:00 in Berlin";
  const auto closed = folder_ / "closed.windlog";
  record_session(closed, kFridayNoon, 60.0,
                 recorded_text(installation_text("hours = \"10:00-13:30\"\nzone = \"Europe/Berlin\"\nfade = 5\n")),
                 three_winds());
  EXPECT_LT(replay(closed).wind_mean_m_s, 1.0);
}

TEST_F(AsRecorded, ItClosesWhereItDidThen) {
  // At 12:00:30 by the recorded clock, and with a fade of 5 s: calm from 12:00:35 on.
  record_session(file_, kFridayNoon - std::chrono::seconds(30), 120.0,
                 recorded_text(installation_text("hours = \"10:00-12:00\"\nzone = \"UTC\"\nfade = 5\n")),
                 three_winds());
  const double open_m_s = replay(file_, "", 30.0).wind_mean_m_s;
  EXPECT_GT(open_m_s, 4.0);
  EXPECT_LT(replay(file_).wind_mean_m_s, 0.45 * open_m_s);
}

TEST_F(AsRecorded, ASensorThatWasOutvotedIsOutvotedAgain) {
  std::vector<RecordedWind> winds = three_winds(5.0);
  winds[2].speed_m_s = [](double time_s) { return 6.0 * gusty_m_s(time_s); };
  record_session(file_, kFridayNoon, 1200.0, recorded_text("[animation]\nrate = 4\n" + installation_text()), winds);
  const double before_m_s = replay(file_, "", 600.0).wind_mean_m_s;
  const double after_m_s = replay(file_, "2026-05-01T12:00:00Z").wind_mean_m_s;
  EXPECT_GT(before_m_s, 10.0) << "it is only disputed for its first quarter of an hour";
  EXPECT_LT(after_m_s, 0.92 * before_m_s);
}

TEST_F(AsRecorded, TheSessionWhereItBeginsHasTheConfigurationAndALaterOneIsNamed) {
  record(installation_text());
  record_session(file_, kFridayNoon + std::chrono::hours(1), 60.0, recorded_text(installation_text("gusts = 0\n")),
                 three_winds());
  const sensing::RecordedInstallation first = installation_in(file_);
  EXPECT_EQ(first.config.shaping.settings.gusts, 1.0);
  EXPECT_THAT(first.remarks,
              ElementsAre(AllOf(HasSubstr("from 2026-05-01T13:00:00Z on (session 2)"), HasSubstr("of session 1"))));
  const sensing::RecordedInstallation second = installation_in(file_, "2026-05-01T13:00:10Z");
  EXPECT_EQ(second.config.shaping.settings.gusts, 0.0);
  EXPECT_EQ(second.begin, kFridayNoon + std::chrono::hours(1) + std::chrono::seconds(10));
  EXPECT_THAT(second.remarks, IsEmpty());
}

TEST_F(AsRecorded, ASensorWithoutAReadingIsSilentAndDoesNotKeepItFromEnding) {
  std::vector<RecordedWind> winds = three_winds();
  winds.pop_back();
  record_session(file_, kFridayNoon, 20.0, recorded_text(installation_text()), winds);
  EXPECT_THAT(installation_in(file_).remarks, ElementsAre("sensor yard has no reading, and is silent"));
  const LockstepResult result = replay(file_);
  EXPECT_EQ(result.readings, 40U);
  EXPECT_NEAR(result.log_duration_s, 19.0, 0.1);
}

TEST_F(AsRecorded, AConfigurationThatIsNotUnderstoodIsRefusedByItsKeys) {
  record_session(file_, kFridayNoon, 5.0, "[wind]\nfuture_key = 3\n[[sensor]]\ndriver = \"line\"\ndevice = \"x\"\n",
                 three_winds());
  try {
    static_cast<void>(sensing::recorded_installation(file_, {}));
    FAIL() << "it has a key that nobody knows";
  } catch (const settings::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("wall.windlog: configuration of session 1:2:"),
                                    HasSubstr("wind.future_key"), HasSubstr("was written by yuragi 0.2.0")));
  }
}

TEST_F(AsRecorded, WhatHoldsNoConfigurationIsRefused) {
  record_session(file_, kFridayNoon, 5.0, "", three_winds());
  const auto refused = sensing::recorded_installation(file_, {});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("configuration of session 1: is empty"));
  const auto late = sensing::recorded_installation(file_, {.playback = {.start = "2027-01-01T00:00:00Z"}});
  ASSERT_FALSE(late);
  EXPECT_THAT(late.error().message, HasSubstr("ends before 2027"));
}

}  // namespace
}  // namespace yuragi::daemon::tools::offline
