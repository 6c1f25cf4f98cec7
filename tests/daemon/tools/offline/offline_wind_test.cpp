// What the offline tools make of recordings of several sensors: the daemon's vote counts here, too.
#include "daemon/tools/offline/offline_wind.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/sensing/sensor_hub.hpp"
#include "tests/daemon/tools/offline/recorded_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::tools::offline {
namespace {

constexpr double kDuration_s = 2400.0;
/// The vote hears means of 5 minutes for 10 more; then the wind is handed over.
constexpr double kVoted_s = 1000.0;

struct Means {
  double before_m_s = 0.0;  ///< the first five minutes, in which nobody has voted
  double after_m_s = 0.0;   ///< from kVoted_s on
  std::uint64_t withheld = 0;
};

class SeveralRecorded : public ::testing::Test {
 protected:
  SeveralRecorded() {
    const auto seized = [](double) { return 0.0; };
    record_session(file_, kFridayNoon, kDuration_s, "",
                   {{.sensor = "mast", .speed_m_s = gusty_m_s},
                    {.sensor = "roof", .speed_m_s = gusty_m_s},
                    {.sensor = "yard", .speed_m_s = seized}});
  }

  /// The mean speeds of the wind that the recorded sensors make together.
  Means wind_of(const std::vector<std::string>& sensors, const settings::Config& config) const {
    std::vector<drivers::windlog::WindlogPlayback> playbacks;
    for (const std::string& sensor : sensors) {
      playbacks.push_back(drivers::windlog::WindlogPlayback::open(file_, {.sensor = sensor}).value());
    }
    wind::blend::BlendSettings settings = sensing::blend_settings_of(config);
    settings.sources.assign(sensors.size(), {.priority = 1});
    settings.rate_hz = 4.0;
    wind::blend::BlendedEstimator estimator(sensors.size(), settings, sensing::make_gust_noise(config));
    Means means;
    std::size_t before = 0;
    std::size_t after = 0;
    const OfflineWindOptions options{.rate_hz = 4.0, .rules = sensing::jury_rules_of(config.sensors[0])};
    const auto run = run_offline(playbacks, estimator, options, [&](double time_s, const wind::WindState& state) {
      const double speed_m_s = speed_of(state.wind);
      if (time_s >= 60.0 && time_s < 300.0) {
        means.before_m_s += speed_m_s;
        ++before;
      } else if (time_s >= kVoted_s) {
        means.after_m_s += speed_m_s;
        ++after;
      }
    });
    EXPECT_TRUE(run) << (run ? "" : run.error().message);
    means.before_m_s /= static_cast<double>(before);
    means.after_m_s /= static_cast<double>(after);
    means.withheld = run->withheld;
    return means;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "three.windlog";
};

TEST_F(SeveralRecorded, OneThatHasSeizedIsOutvotedAsInTheDaemon) {
  const settings::Config config = settings::default_config();
  const Means two = wind_of({"mast", "roof"}, config);
  const Means three = wind_of({"mast", "roof", "yard"}, config);
  EXPECT_EQ(two.withheld, 0U);
  EXPECT_LT(three.before_m_s, 0.8 * two.before_m_s) << "nobody has voted yet";
  EXPECT_NEAR(three.after_m_s, two.after_m_s, 0.05 * two.after_m_s);
  EXPECT_NEAR(static_cast<double>(three.withheld), kDuration_s - 900.0, 10.0);
}

TEST_F(SeveralRecorded, WhatIsNotToBeComparedHasNoVote) {
  settings::Config config = settings::default_config();
  config.sensors[0].is_compared = false;
  const Means three = wind_of({"mast", "roof", "yard"}, config);
  EXPECT_EQ(three.withheld, 0U);
  EXPECT_LT(three.after_m_s, 0.8 * wind_of({"mast", "roof"}, config).after_m_s);
}

}  // namespace
}  // namespace yuragi::daemon::tools::offline
