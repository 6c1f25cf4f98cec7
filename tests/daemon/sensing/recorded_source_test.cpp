// A recording of a source that speaks on change only, played in place of a sensor: its pauses are no silence.
#include "daemon/sensing/recorded_source.hpp"

#include <gtest/gtest.h>

#include "daemon/sensing/sensor_hub.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::sensing {
namespace {

using namespace std::chrono_literals;

class RecordedSilence : public ::testing::Test {
 protected:
  /// Something each 2 s for a minute, and then a calm of half an hour.
  RecordedSilence() {
    std::vector<wind::Reading> readings;
    readings.reserve(32);
    for (std::int64_t i = 0; i < 30; ++i) {
      readings.push_back(test::reading_at(2000 * i, 3.0 + 0.1 * static_cast<double>(i % 7)));
    }
    readings.push_back(test::reading_at(60'000, 0.0));
    readings.push_back(test::reading_at(1'860'000, 2.0));
    test::write_session(file_, readings, "home", "mqtt", "topic = \"wind\"\nsilence = 3600.0\non_change = true\n");
  }

  settings::Config config(const std::string& rate = "1.0") const {
    return settings::parse_config(
        "[[sensor]]\ndriver = \"windlog\"\nfile = \"" + file_.string() + "\"\nrate = " + rate + "\n", "wall.toml");
  }

  /// In how many of the steps of the calm the replayed sensor was called stale.
  int stale_steps(const settings::Config& config) {
    ManualClock clock;
    SensorHub hub(
        config, clock, shared_gusts(), [](std::size_t, const wind::Reading&) {}, 0.0, SensorThread::kOfCaller);
    int stale = 0;
    for (int i = 0; i < 3000; ++i) {
      clock.advance(500ms);
      hub.advance();
      if (hub.status().at(0).state == wind::judging::SensorState::kStale) ++stale;
    }
    return stale;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "home.windlog";
};

TEST_F(RecordedSilence, IsNoGapWhereTheSourceSpokeOnChange) {
  EXPECT_GT(stale_steps(config()), 2000) << "what is not known of a recording";
  EXPECT_EQ(stale_steps(with_recorded_sources(config())), 0);
}

TEST_F(RecordedSilence, IsThatOfTheRecordingAtItsRate) {
  EXPECT_EQ(with_recorded_sources(config()).sensors[0].blend.unchanged_for_s, 3600.0);
  EXPECT_EQ(with_recorded_sources(config("4.0")).sensors[0].blend.unchanged_for_s, 900.0);
  EXPECT_EQ(recorded_source(file_, "home").unchanged_for_s, 3600.0);
  EXPECT_EQ(recorded_source(file_, "*").unchanged_for_s, 0.0);
  EXPECT_EQ(recorded_source(file_, "away").unchanged_for_s, 0.0);
  EXPECT_EQ(recorded_source(folder_ / "none.windlog", "").unchanged_for_s, 0.0);

  EXPECT_EQ(recorded_source(file_, "home").value, std::nullopt) << "MQTT does not state what is published";
  settings::Config with_fallback = settings::default_config();
  with_fallback.wind.fallback = {.recording = file_, .after_s = 5.0};
  EXPECT_EQ(blend_settings_of(with_recorded_sources(with_fallback)).sources.back().unchanged_for_s, 3600.0);
}

}  // namespace
}  // namespace yuragi::daemon::sensing
