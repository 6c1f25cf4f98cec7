#include "daemon/feeds/osc_cue.hpp"

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::feeds {
namespace {

using settings::feeds::OscCondition;
using settings::feeds::OscCue;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kTick_s = 0.1;

/// The times at which the cue is sent during a speed over time.
std::vector<double> sent_during(const OscCue& cue, double duration_s, const std::function<double(double)>& speed_m_s,
                                const std::function<bool(double)>& is_live = {}) {
  CueTrigger trigger(cue);
  std::vector<double> times;
  values::Moment moment;
  moment.names = std::make_shared<const values::Names>(values::Names{.sensors = {"roof"}});
  for (int i = 0; i * kTick_s < duration_s; ++i) {
    const double time_s = i * kTick_s;
    moment.time_s = time_s;
    moment.shaped[values::Quantity::kSpeed] = speed_m_s(time_s);
    moment.sensors = {{.state = !is_live || is_live(time_s) ? wind::judging::SensorState::kLive
                                                            : wind::judging::SensorState::kStale}};
    if (trigger.is_due(moment, values::Wind::kShaped)) times.push_back(time_s);
  }
  return times;
}

TEST(CueTriggerTest, AGustIsARiseWithin2Seconds) {
  const OscCue gust{.when = OscCondition::kGust, .rise_m_s = 3.0, .again_after_s = 20.0};
  const auto steep = [](double time_s) { return time_s < 10.0 ? 4.0 : 8.0; };
  EXPECT_THAT(sent_during(gust, 60.0, steep), ElementsAre(testing::DoubleNear(10.0, 0.11)));
  const auto slow = [](double time_s) { return 4.0 + time_s / 2.0; };  // 1 m/s in 2 s
  EXPECT_THAT(sent_during(gust, 60.0, slow), IsEmpty());
}

TEST(CueTriggerTest, GustsAreNotSentBeforeAgainAfter) {
  const OscCue gust{.when = OscCondition::kGust, .rise_m_s = 3.0, .again_after_s = 20.0};
  const auto pulses = [](double time_s) { return std::fmod(time_s, 5.0) < 1.0 ? 9.0 : 4.0; };
  const std::vector<double> times = sent_during(gust, 100.0, pulses);
  ASSERT_GE(times.size(), 4U);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GE(times[i] - times[i - 1], 20.0 - 1e-9);
}

TEST(CueTriggerTest, WindAboveIsSentOnceUntilItIsOver) {
  const OscCue above{.when = OscCondition::kWindAbove, .speed_m_s = 10.0, .after_s = 3.0, .again_after_s = 0.0};
  const auto storm = [](double time_s) { return (time_s >= 10.0 && time_s < 30.0) || time_s >= 50.0 ? 12.0 : 5.0; };
  EXPECT_THAT(sent_during(above, 70.0, storm),
              ElementsAre(testing::DoubleNear(13.0, 0.11), testing::DoubleNear(53.0, 0.11)));
}

TEST(CueTriggerTest, CalmIsSentOnceItHasLasted) {
  const OscCue calm{.when = OscCondition::kCalm, .after_s = 5.0};
  EXPECT_EQ(calm.limit_m_s(), 1.0);
  EXPECT_THAT(sent_during(calm, 20.0, [](double time_s) { return time_s < 2.0 ? 3.0 : 0.5; }),
              ElementsAre(testing::DoubleNear(7.0, 0.11)));
}

TEST(CueTriggerTest, ASensorIsSilent) {
  const OscCue silent{.when = OscCondition::kSensorSilent, .after_s = 1.0, .sensor = "roof"};
  const auto steady = [](double) { return 5.0; };
  const auto is_live = [](double time_s) { return time_s < 10.0; };
  EXPECT_THAT(sent_during(silent, 30.0, steady, is_live), ElementsAre(testing::DoubleNear(11.0, 0.11)));
  const OscCue patient{.when = OscCondition::kSensorSilent, .sensor = "roof"};
  EXPECT_THAT(sent_during(patient, 30.0, steady, is_live), ElementsAre(testing::DoubleNear(15.0, 0.11)));
  const OscCue another{.when = OscCondition::kSensorSilent, .sensor = "cellar"};
  EXPECT_THAT(sent_during(another, 30.0, steady, is_live), IsEmpty());
}

}  // namespace
}  // namespace yuragi::daemon::feeds
