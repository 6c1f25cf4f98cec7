// How stations speak: regularly, several times over, on change only, at two rates. A live one keeps its weight and is
// never called stale; one that really goes silent is found within the documented time.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/wind/blend/reading_interval.hpp"
#include "tests/engine/wind/blend/blend_run.hpp"

namespace yuragi::wind::blend {
namespace {

/// When a station speaks, and what: the same number is the same message.
struct Spoken {
  double time_s = 0.0;
  int message = 0;
};
using Speech = std::vector<Spoken>;

constexpr double kSpeech_s = 480.0;
constexpr double kRepeat_s = 0.07;

/// A number from 0 to 1 that looks random.
double scattered(int i) {
  const double big = std::sin(12.9898 * (i + 1)) * 43758.5453;
  return big - std::floor(big);
}

/// A message every `interval_s`, which is said `times` times in a row.
Speech bursts(double interval_s, int times) {
  Speech speech;
  for (int i = 0; i * interval_s < kSpeech_s; ++i) {
    for (int k = 0; k < times; ++k) speech.push_back({i * interval_s + k * kRepeat_s, i});
  }
  return speech;
}

Speech jittered(double interval_s, double part) {
  Speech speech;
  for (int i = 0; i * interval_s < kSpeech_s; ++i) {
    speech.push_back({(i + part * (scattered(i) - 0.5)) * interval_s, i});
  }
  std::ranges::sort(speech, {}, &Spoken::time_s);
  for (Spoken& each : speech) each.time_s -= speech.front().time_s;
  return speech;
}

/// Intervals in turn, over and over.
Speech in_turn(const std::vector<double>& intervals_s) {
  Speech speech;
  double time_s = 0.0;
  for (int i = 0; time_s < kSpeech_s; ++i) {
    speech.push_back({time_s, i});
    time_s += intervals_s[static_cast<std::size_t>(i) % intervals_s.size()];
  }
  return speech;
}

/// Another interval from half-way on.
Speech changing(double before_s, double after_s) {
  Speech speech;
  double time_s = 0.0;
  for (int i = 0; time_s < kSpeech_s; ++i) {
    speech.push_back({time_s, i});
    time_s += time_s < 0.5 * kSpeech_s ? before_s : after_s;
  }
  return speech;
}

/// Several messages with something else in each, in quick succession.
Speech different_at_once(double interval_s, int count) {
  Speech speech = bursts(interval_s, count);
  for (std::size_t i = 0; i < speech.size(); ++i) speech[i].message = static_cast<int>(i);
  return speech;
}

struct PatternCase {
  std::string name;
  Speech speech;
  double longest_pause_s = 0.0;
  double known_from_s = 0.0;   ///< from here on it is known how it speaks
  double least_weight = 0.99;  ///< from then on
};

const std::vector<PatternCase>& pattern_cases() {
  static const std::vector<PatternCase> all = {
      {"EveryTenth", bursts(0.1, 1), 0.1, 20.0},
      {"EverySecond", bursts(1.0, 1), 1.0, 20.0},
      {"EverySixteenSeconds", bursts(16.0, 1), 16.0, 60.0},
      {"EveryMinute", bursts(60.0, 1), 60.0, 200.0},
      {"Jittered", jittered(1.0, 0.4), 1.4, 20.0, 0.95},
      {"JitteredSlow", jittered(10.0, 0.4), 14.0, 60.0, 0.95},
      {"JitteredALot", jittered(10.0, 0.8), 18.0, 60.0, 0.85},
      {"Doubled", bursts(1.0, 2), 1.0, 20.0},
      {"DoubledSlow", bursts(16.0, 2), 16.0, 60.0},
      {"BurstsOfThree", bursts(18.0, 3), 18.0, 60.0},
      {"BurstsOfFour", bursts(10.0, 4), 10.0, 60.0},
      {"BurstsOfFive", bursts(48.0, 5), 48.0, 150.0},
      {"ThreeAtOnce", different_at_once(10.0, 3), 10.0, 60.0},
      {"TwoRatesInTurn", in_turn({2.0, 10.0}), 10.0, 60.0},
      {"TwoRatesByFives", in_turn({1.0, 1.0, 1.0, 1.0, 1.0, 10.0, 10.0, 10.0, 10.0, 10.0}), 10.0, 60.0},
      // Bands that it resolves from now on are faded in; three gaps tell that it has become slower.
      {"FasterFromNowOn", changing(10.0, 1.0), 10.0, 60.0, 0.5},
      {"SlowerFromNowOn", changing(1.0, 4.0), 4.0, 20.0, 0.3},
  };
  return all;
}

std::string name_of_case(const testing::TestParamInfo<PatternCase>& info) {
  return info.param.name;
}
void PrintTo(const PatternCase& pattern, std::ostream* out) {
  *out << pattern.name;
}

class ReadingPatterns : public testing::TestWithParam<PatternCase> {};

/// What came of a speech, once it is known how the station speaks; and for how long it was stale before that.
struct Played {
  double least_weight = 1.0;
  double highest_m_s = 0.0;
  double stale_s = 0.0;
  double stale_at_first_s = 0.0;
};
/// `wind_m_s`: the speed in a message.
template <class Wind>
Played play(BlendRun& run, const PatternCase& pattern, Wind wind_m_s) {
  Played played;
  double time_s = 0.0;
  for (const Spoken& each : pattern.speech) {
    run.run_for(each.time_s - time_s, [&](const State& state) {
      time_s += kBlendTick_s;
      const bool is_known = time_s >= pattern.known_from_s;
      if (run.report().health == SourceHealth::kStale) {
        (is_known ? played.stale_s : played.stale_at_first_s) += kBlendTick_s;
      }
      if (!is_known) return;
      played.least_weight = std::min(played.least_weight, state.live_weight);
      played.highest_m_s = std::max(played.highest_m_s, speed_of(state.wind));
    });
    run.read(wind_m_s(each.message), 200.0);
  }
  return played;
}

TEST_P(ReadingPatterns, ALiveStationKeepsItsWeight) {
  BlendRun run(1, BlendRun::usual());
  const Played played = play(run, GetParam(), [](int message) { return 3.0 + 2.0 * scattered(message); });
  EXPECT_GE(played.least_weight, GetParam().least_weight);
  EXPECT_EQ(played.stale_s, 0.0);
}

TEST_P(ReadingPatterns, ACalmStaysACalm) {
  BlendRun run(1, BlendRun::usual());
  const Played played = play(run, GetParam(), [](int) { return 0.0; });
  EXPECT_GE(played.least_weight, GetParam().least_weight);
  EXPECT_LT(played.highest_m_s, 0.1);
  EXPECT_EQ(played.stale_s, 0.0);
}

TEST_P(ReadingPatterns, ASilentStationIsFound) {
  BlendRun run(1, BlendRun::usual());
  play(run, GetParam(), [](int message) { return 3.0 + 2.0 * scattered(message); });
  const double interval_s = run.report().interval_s;
  EXPECT_LE(interval_s, 1.5 * GetParam().longest_pause_s) << "its interval is known";
  const double allowed_s = std::max(1.0, 5.0 * interval_s);
  run.run_for(allowed_s - 0.2);
  EXPECT_EQ(run.report().health, SourceHealth::kLive);
  run.run_for(0.4);
  EXPECT_EQ(run.report().health, SourceHealth::kStale);
}

TEST(ReadingPatterns, RepetitionsAreNoSilenceFromTheFirstBurstOn) {
  for (const int times : {2, 3, 4, 5}) {
    BlendRun run(1, BlendRun::usual());
    const PatternCase pattern{"", bursts(18.0, times), 18.0, 0.0};
    const Played played = play(run, pattern, [](int message) { return 3.0 + 2.0 * scattered(message); });
    EXPECT_EQ(played.stale_s, 0.0) << times;
  }
}

TEST(ReadingPatterns, ARepetitionIsTheSameReadingToTheTurbulence) {
  const auto fitted = [](int times) {
    BlendRun run(1, BlendRun::usual());
    play(run, PatternCase{"", bursts(18.0, times), 18.0, 0.0},
         [](int message) { return 3.0 + 2.0 * scattered(message); });
    return run.estimator().turbulence().intensity;
  };
  EXPECT_NEAR(fitted(3), fitted(1), 0.01);
}

/// Old recordings of regular stations are replayed to the same wind.
TEST(ReadingPatterns, ARegularOneHasTheMedianOfItsLastNineGapsToTheBit) {
  for (const double interval_s : {0.05, 1.0, 2.5, 14.0}) {
    for (const double jitter : {0.0, 0.2, 0.6, 1.0}) {
      ReadingInterval interval;
      std::vector<double> gaps_s;
      for (int i = 0; i < 500; ++i) {
        const bool is_outage = i % 40 == 20;
        gaps_s.push_back(interval_s * (is_outage ? 50.0 : 1.0 + jitter * (scattered(i) - 0.5)));
        EXPECT_TRUE(interval.take(gaps_s.back(), i % 7 == 0)) << "each is a new one";
        const std::size_t known = std::min<std::size_t>(gaps_s.size(), 9);
        std::vector<double> last_s(gaps_s.end() - static_cast<std::ptrdiff_t>(known), gaps_s.end());
        std::ranges::sort(last_s);
        ASSERT_EQ(interval.interval_s(), last_s[known / 2]) << interval_s << " s, " << jitter << ", " << i;
      }
    }
  }
}

TEST(ReadingPatterns, OneOutageOrTwoFarApartAreNoPause) {
  BlendRun run(1, BlendRun::usual());
  for (int i = 0; i < 60; ++i) {
    run.read(3.0 + scattered(i), 200.0);
    run.run_for(i % 20 == 10 ? 30.0 : 1.0);
    EXPECT_NEAR(run.report().interval_s, i > 0 ? 1.0 : 0.0, 0.02) << i;
  }
}

/// Speaks on change only, every second in a wind; in a calm it is silent.
Settings on_change(double unchanged_for_s) {
  Settings settings = BlendRun::usual();
  settings.sources.push_back({.unchanged_for_s = unchanged_for_s});
  return settings;
}

TEST(ReadingPatterns, OnChangeASilenceIsACalmThatLasts) {
  BlendRun run(1, on_change(3600.0));
  for (int i = 0; i < 60; ++i) {
    run.read(3.0 + scattered(i), 200.0);
    run.run_for(1.0);
  }
  run.read(0.0, 200.0);
  run.run_for(300.0);
  double highest_m_s = 0.0;
  run.run_for(3000.0, [&](const State& state) { highest_m_s = std::max(highest_m_s, speed_of(state.wind)); });
  EXPECT_LT(highest_m_s, 0.1) << "no wind is invented";
  EXPECT_GT(run.state().live_weight, 0.99);
  EXPECT_EQ(run.report().health, SourceHealth::kLive);
  EXPECT_NEAR(run.report().interval_s, 1.0, 0.02) << "the interval is that of changes";

  run.run_for(299.0);
  EXPECT_EQ(run.report().health, SourceHealth::kLive);
  run.run_for(2.0);
  EXPECT_EQ(run.report().health, SourceHealth::kStale) << "its bound";
}

TEST(ReadingPatterns, OnChangeTheSameAgainIsNothingNew) {
  BlendRun run(1, on_change(100.0));
  for (int i = 0; i < 60; ++i) {
    run.read(3.0 + scattered(i / 3), 200.0);
    run.run_for(1.0);
  }
  EXPECT_NEAR(run.report().interval_s, 3.0, 0.05);
  run.run_for(98.0);
  EXPECT_EQ(run.report().health, SourceHealth::kLive) << "but it is heard";
}

INSTANTIATE_TEST_SUITE_P(All, ReadingPatterns, testing::ValuesIn(pattern_cases()), name_of_case);

}  // namespace
}  // namespace yuragi::wind::blend
