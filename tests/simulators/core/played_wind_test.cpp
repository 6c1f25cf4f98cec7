#include "simulators/core/played_wind.hpp"

#include <gtest/gtest.h>

#include "drivers/windlog/windlog_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::simulators::core {
namespace {

using namespace std::chrono_literals;

TEST(PlayedWind, ThatIsSyntheticIsTheEnginesWind) {
  const wind::turbulence::SyntheticWindSettings settings{.mean_speed_m_s = 6.0, .mean_direction_deg = 100.0, .seed = 5};
  const auto played = play_synthetic_wind(settings);
  const wind::turbulence::SyntheticWind wind(settings);
  for (int step = 0; step < 35; ++step) {
    const double time_s = 1.7 * step;
    const PlayedMoment moment = played->at(time_s);
    EXPECT_EQ(moment.speed_m_s, speed_of(wind.at(time_s)));
    EXPECT_EQ(moment.direction_deg, wind::direction_from_deg(wind.at(time_s)));
  }
}

TEST(PlayedWind, ThatIsRecordedKeepsItsPaceHoldsBetweenReadingsAndBeginsAgain) {
  const test::TemporaryFolder folder;
  const auto file = folder / "three.windlog";
  {
    auto writer = drivers::windlog::Writer::open(file);
    ASSERT_TRUE(writer.has_value());
    const Instant start{MonoTime(1h), UtcTime(std::chrono::sys_days(std::chrono::year(2024) / 6 / 1))};
    ASSERT_TRUE(writer->begin_session({start, "test", ""}));
    const auto sensor = writer->add_sensor("mast", "test", "");
    ASSERT_TRUE(sensor.has_value());
    const auto append = [&](Nanoseconds at, double speed_m_s, std::optional<double> direction_deg) {
      wind::Reading reading;
      reading.time = {start.mono + at, start.utc + at};
      reading.speed_m_s = speed_m_s;
      reading.direction_deg = direction_deg;
      ASSERT_TRUE(writer->append(*sensor, reading));
    };
    append(0s, 1.0, 90.0);
    append(1s, 2.0, std::nullopt);
    append(2s, 3.0, 180.0);
    ASSERT_TRUE(writer->close());
  }

  const auto played = play_recorded_wind(file.string());
  EXPECT_EQ(played->at(0.0).speed_m_s, 1.0);
  EXPECT_EQ(played->at(0.9).speed_m_s, 1.0);
  EXPECT_EQ(played->at(1.0).speed_m_s, 2.0);
  EXPECT_EQ(played->at(1.5).direction_deg, 90.0);  // the last known one
  EXPECT_EQ(played->at(2.0).direction_deg, 180.0);
  EXPECT_EQ(played->at(2.0).speed_m_s, 3.0);

  // Whatever pause lies between two rounds, the beginning comes back.
  bool begins_again = false;
  for (int tenth = 20; tenth < 100; ++tenth) begins_again = begins_again || played->at(0.1 * tenth).speed_m_s == 1.0;
  EXPECT_TRUE(begins_again);
}

TEST(PlayedWind, ThatIsNoRecordingIsRefused) {
  EXPECT_THROW(play_recorded_wind("/no/such/file.windlog"), std::runtime_error);
}

/// 1 m/s more each second.
class GrowingWind final : public PlayedWind {
 public:
  PlayedMoment at(double time_s) override { return {time_s, 90.0}; }
};

TEST(MeasuredWind, IsTheWindButForWhatFreezesOrSpikesIt) {
  MeasuredWind wind(std::make_unique<GrowingWind>());
  EXPECT_EQ(wind.at(1.0, std::nullopt).speed_m_s, 1.0);
  EXPECT_EQ(wind.at(2.0, FaultKind::kFreeze).speed_m_s, 1.0);
  EXPECT_EQ(wind.at(3.0, FaultKind::kFreeze).speed_m_s, 1.0);
  EXPECT_EQ(wind.at(4.0, FaultKind::kGarbage).speed_m_s, 4.0);
  EXPECT_EQ(wind.at(5.0, FaultKind::kSpike).speed_m_s, 55.0);
  EXPECT_EQ(wind.at(6.0, FaultKind::kFreeze).speed_m_s, 5.0);
  EXPECT_EQ(wind.at(7.0, std::nullopt).speed_m_s, 7.0);
}

}  // namespace
}  // namespace yuragi::simulators::core
