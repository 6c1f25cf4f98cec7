#include "daemon/tools/calibration/calibration_source.hpp"

#include <atomic>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/windlog/windlog_writer.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::tools::calibration {
namespace {

using ::testing::HasSubstr;

constexpr const char* kNoDaemon = "127.0.0.1:1";

/// A sensor that says 3 m/s from 350 degrees whenever it is asked, or only that it is looking for its device.
template <bool kSpeaks>
class AskedSensor final : public drivers::sensor::Sensor {
 public:
  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) override {
    if (kSpeaks) {
      sink.link(wind::LinkState::kConnected, "");
      sink.reading({.time = clock.now(), .speed_m_s = 3.0, .direction_deg = 350.0, .gust_m_s = {}});
    } else {
      sink.link(wind::LinkState::kConnecting, "no such port");
    }
    return clock.now().mono + std::chrono::milliseconds(1);
  }
};

template <bool kSpeaks>
const drivers::sensor::DriverDescription kAskedDriver{
    .name = kSpeaks ? "speaking" : "silent",
    .summary = "",
    .parameters = {},
    .open = [](const ParameterValues&) -> std::unique_ptr<drivers::sensor::Sensor> {
      return std::make_unique<AskedSensor<kSpeaks>>();
    }};

TEST(CalibrationSource, ListensToTheDeviceForAsLongAsItIsTold) {
  ManualClock clock;
  settings::SensorConfig roof = settings::default_sensor("roof", kAskedDriver<true>, {});
  roof.calibration.gain = 2.0;
  const auto source = make_live_source({&roof}, kNoDaemon, clock).value();
  EXPECT_EQ(source->description(), "the devices themselves");
  EXPECT_TRUE(source->is_live());

  int received = 0;
  double last_s = 0.0;
  const CollectedReadings collected = source
                                          ->collect({.duration_s = 5.0},
                                                    [&](double elapsed_s, const CollectedReadings& so_far) {
                                                      EXPECT_EQ(so_far.size(), 1U);
                                                      EXPECT_GE(elapsed_s, last_s);
                                                      last_s = elapsed_s;
                                                      ++received;
                                                      clock.advance(std::chrono::milliseconds(500));
                                                    })
                                          .value();
  EXPECT_GE(last_s, 5.0);
  EXPECT_GE(received, 10);
  ASSERT_FALSE(collected[0].readings.empty());
  for (const TimedReading& one : collected[0].readings) {
    EXPECT_EQ(one.reading.speed_m_s, 3.0) << "as the sensor says it, before calibration";
    EXPECT_GE(one.time_s, 0.0);
  }
}

TEST(CalibrationSource, ASensorThatStaysSilentIsToldWithItsReason) {
  ManualClock clock;
  const settings::SensorConfig roof = settings::default_sensor("roof", kAskedDriver<true>, {});
  const settings::SensorConfig mast = settings::default_sensor("mast", kAskedDriver<false>, {});
  const auto source = make_live_source({&roof, &mast}, kNoDaemon, clock).value();
  const auto collected = source->collect({.duration_s = 5.0}, [&](double elapsed_s, const CollectedReadings&) {
    EXPECT_EQ(elapsed_s, 0.0) << "the time runs when both have spoken";
    clock.advance(std::chrono::seconds(10));
  });
  ASSERT_FALSE(collected);
  EXPECT_EQ(collected.error().kind, FailureKind::kUnavailable);
  EXPECT_THAT(collected.error().message, HasSubstr("the sensor \"mast\" has sent nothing for 90 s (no such port)"));
}

std::atomic<bool> dying_sensor_is_gone = false;

/// It sends readings until it is gone.
class DyingSensor final : public drivers::sensor::Sensor {
 public:
  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) override {
    if (dying_sensor_is_gone) {
      sink.link(wind::LinkState::kConnecting, "its plug is out");
    } else {
      sink.link(wind::LinkState::kConnected, "");
      sink.reading({.time = clock.now(), .speed_m_s = 3.0, .direction_deg = {}, .gust_m_s = {}});
    }
    return clock.now().mono + std::chrono::milliseconds(1);
  }
};

const drivers::sensor::DriverDescription kDyingDriver{
    .name = "dying",
    .summary = "",
    .parameters = {},
    .open = [](const ParameterValues&) -> std::unique_ptr<drivers::sensor::Sensor> {
      return std::make_unique<DyingSensor>();
    }};

TEST(CalibrationSource, ASensorThatIsLostMeanwhileEndsIt) {
  ManualClock clock;
  const settings::SensorConfig roof = settings::default_sensor("roof", kDyingDriver, {});
  const auto source = make_live_source({&roof}, kNoDaemon, clock).value();
  const auto collected = source->collect({.duration_s = 1e6}, [&](double, const CollectedReadings& so_far) {
    if (!so_far[0].readings.empty()) dying_sensor_is_gone = true;
    clock.advance(std::chrono::milliseconds(300));
  });
  ASSERT_FALSE(collected);
  EXPECT_EQ(collected.error().kind, FailureKind::kUnavailable);
  EXPECT_THAT(collected.error().message, HasSubstr("the sensor \"roof\" was lost meanwhile (its plug is out)"));
}

TEST(CalibrationSource, ARecordingGivesAPartAndTheSettingsItWasMadeWith) {
  const test::TemporaryFolder folder;
  const auto file = folder / "field.windlog";
  {
    auto writer = drivers::windlog::Writer::open(file).value();
    const auto at = [](double time_s) {
      return Instant{MonoTime(from_seconds(100.0 + time_s)), UtcTime(from_seconds(1.7e9 + time_s))};
    };
    for (int session = 0; session < 2; ++session) {
      const double begin_s = 100.0 * session;
      ASSERT_TRUE(writer.begin_session({at(begin_s), "test", ""}));
      const auto roof = writer.add_sensor("roof", "speaking", session == 0 ? "gain = 1.0" : "gain = 2.0").value();
      const auto other = writer.add_sensor("other", "silent", "").value();
      for (int i = 0; i < 50; ++i) {
        const double time_s = begin_s + i;
        ASSERT_TRUE(
            writer.append(roof, {.time = at(time_s), .speed_m_s = 1.0 + session, .direction_deg = {}, .gust_m_s = {}}));
        ASSERT_TRUE(writer.append(other, {.time = at(time_s), .speed_m_s = 9.0, .direction_deg = {}, .gust_m_s = {}}));
      }
    }
    ASSERT_TRUE(writer.close());
  }
  const settings::SensorConfig roof = settings::default_sensor("roof", kAskedDriver<true>, {});
  const auto source = make_recorded_source({&roof}, file).value();
  EXPECT_FALSE(source->is_live());
  const auto collect = [&](const Stretch& stretch) {
    return source->collect(stretch, [](double, const CollectedReadings&) {}).value()[0];
  };
  EXPECT_EQ(collect({}).readings.size(), 100U);
  EXPECT_EQ(collect({}).settings, (std::set<std::string>{"gain = 1.0", "gain = 2.0"}));

  const SensorReadings part = collect({.from_s = 10.0, .to_s = 20.0});
  ASSERT_EQ(part.readings.size(), 10U);
  EXPECT_EQ(part.readings.front().time_s, 10.0);
  EXPECT_EQ(part.settings, std::set<std::string>{"gain = 1.0"});

  const settings::SensorConfig mast = settings::default_sensor("mast", kAskedDriver<true>, {});
  EXPECT_EQ(make_recorded_source({&mast}, file).error().kind, FailureKind::kBadData);
  EXPECT_EQ(make_recorded_source({&roof}, folder / "none.windlog").error().kind, FailureKind::kNoInput);
}

}  // namespace
}  // namespace yuragi::daemon::tools::calibration
