// What the offline tools make of recordings of several sensors: the daemon's vote counts here, too.
#include "daemon/tools/offline/offline_wind.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/sensing/sensor_hub.hpp"
#include "engine/wind/ground/wind_tapes.hpp"
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
    std::vector<drivers::windlog::Playback> playbacks;
    playbacks.reserve(sensors.size());
    for (const std::string& sensor : sensors) {
      playbacks.push_back(drivers::windlog::Playback::open(file_, {.sensor = sensor}).value());
    }
    wind::blend::Settings settings = sensing::blend_settings_of(config);
    settings.sources.assign(sensors.size(), {.priority = 1});
    settings.rate_hz = 4.0;
    wind::blend::BlendedEstimator estimator(sensors.size(), settings, sensing::make_gust_noise(config));
    Means means;
    std::size_t before = 0;
    std::size_t after = 0;
    const WindOptions options{.rate_hz = 4.0, .rules = sensing::jury_rules_of(config.sensors[0])};
    const auto run = run_offline(playbacks, estimator, options, [&](double time_s, const wind::State& state) {
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

/// Two whose readings differ by 1.5, 15 m apart: 7.2 and 4.8 m/s.
class TwoPlaces : public ::testing::Test {
 protected:
  static constexpr double kLearning_s = 4200.0;

  TwoPlaces() {
    // gusty_m_s() has a mean of 5.4 m/s.
    const auto times = [](double factor) { return [factor](double time_s) { return factor * gusty_m_s(time_s); }; };
    record_session(
        file_, kFridayNoon, kLearning_s, "",
        {{.sensor = "east", .speed_m_s = times(7.2 / 5.4)}, {.sensor = "west", .speed_m_s = times(4.8 / 5.4)}});
  }

  struct Outcome {
    double east_m_s = 0.0;  ///< means of the last ten minutes, at each place
    double west_m_s = 0.0;
    double largest_step_m_s = 0.0;  ///< from tick to tick, after the first minute
  };
  Outcome run(bool has_relative_gains) const {
    const settings::Config config = settings::default_config();
    std::vector<drivers::windlog::Playback> playbacks;
    for (const char* sensor : {"east", "west"}) {
      playbacks.push_back(drivers::windlog::Playback::open(file_, {.sensor = sensor}).value());
    }
    wind::blend::Settings settings = sensing::blend_settings_of(config);
    settings.sources = {{.priority = 1, .has_place = true, .east_m = 7.5},
                        {.priority = 1, .has_place = true, .east_m = -7.5}};
    settings.rate_hz = 4.0;
    settings.reach_m = 7.5;
    const auto noise = sensing::make_gust_noise(config);
    wind::blend::BlendedEstimator estimator(2, settings, noise);
    wind::ground::WindTapes tapes;
    WindOptions options{.rate_hz = 4.0, .rules = sensing::jury_rules_of(config.sensors[0])};
    options.has_relative_gains = has_relative_gains;
    Outcome outcome;
    double count = 0.0;
    double before_m_s = 0.0;
    const auto result = run_offline(playbacks, estimator, options, [&](double time_s, const wind::State& state) {
      const double speed_m_s = speed_of(state.wind);
      if (time_s > 60.0)
        outcome.largest_step_m_s = std::max(outcome.largest_step_m_s, std::abs(speed_m_s - before_m_s));
      before_m_s = speed_m_s;
      const wind::ground::Wind ground = written_to(tapes, {state, estimator.ground(), estimator.stroke()});
      if (time_s < kLearning_s - 600.0) return;
      count += 1.0;
      outcome.east_m_s += speed_of(ground.at(*noise, 7.5, 0.0));
      outcome.west_m_s += speed_of(ground.at(*noise, -7.5, 0.0));
    });
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    outcome.east_m_s /= count;
    outcome.west_m_s /= count;
    return outcome;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "places.windlog";
};

TEST_F(TwoPlaces, AreLevelledWithinAnHourWithoutAStep) {
  const Outcome as_read = run(false);
  EXPECT_GT(as_read.east_m_s, 1.2 * as_read.west_m_s) << "no sensor is levelled";
  const Outcome levelled = run(true);
  EXPECT_NEAR(levelled.east_m_s / levelled.west_m_s, 1.0, 0.1);
  EXPECT_NEAR(std::sqrt(levelled.east_m_s * levelled.west_m_s), std::sqrt(7.2 * 4.8), 0.3) << "their common mean";
  EXPECT_LT(levelled.largest_step_m_s, std::sqrt(1.5) * as_read.largest_step_m_s)
      << "gusts of the lower one grow with its gain, and no more";
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
