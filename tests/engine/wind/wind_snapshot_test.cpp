// Snapshots of the wind (engine/base/snapshot.hpp): what makes it, shapes it and carries it over the ground goes on
// with the same bits after a save and a load, and bytes that are not its snapshot are refused and change nothing.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/snapshot.hpp"
#include "engine/math/philox.hpp"
#include "engine/wind/blend/blended_estimator.hpp"
#include "engine/wind/shaping/wind_shaping.hpp"
#include "engine/wind/view_wind.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/scripted_wind.hpp"
#include "tests/support/station_wind.hpp"

namespace yuragi::wind {
namespace {

constexpr std::uint64_t kTicks_hz = 60;
constexpr std::uint64_t kMadeOf = 11;

/// Everything between the sensors and the scenes.
class WindChain {
 public:
  /// `sources`: how many of those that there are.
  explicit WindChain(SimdRow row, MonoTime begin = {}, std::size_t sources = kSources)
      : heard_(sources),
        begin_(begin),
        site_(std::make_shared<turbulence::SiteSpectrum>()),
        estimator_(sources, blend_settings(site_, sources), station_gusts()),
        shaping_(shaping_settings(), station_gusts()),
        tapes_(sources, row) {}

  void list_state(StatePass& pass) { pass(estimator_, shaping_, tapes_, view_); }

  /// The others are silent.
  void hear(std::size_t sources) { heard_ = sources; }

  /// What the scenes get at a tick.
  ground::Wind at(std::uint64_t tick) {
    const MonoTime now = begin_ + from_seconds(static_cast<double>(tick) / static_cast<double>(kTicks_hz));
    for (std::size_t source = 0; source < heard_; ++source) {
      if (const auto reading = reading_of(source, tick, now)) estimator_.accept(source, *reading);
    }
    driving_.state = estimator_.advance(now);
    driving_.ground = estimator_.ground();
    driving_.stroke = estimator_.stroke();
    const std::uint64_t second = tick / kTicks_hz;
    shaping::ByHand by_hand;
    if (second % 50 >= 35 && second % 50 < 42) by_hand.wind = shaping::HeldWind{6.0, 120.0};
    shaping_.shape(driving_, second % 70 < 60, true, by_hand);
    view_.advance(1.0 / static_cast<double>(kTicks_hz), driving_.state.wind, driving_.state.live_weight > 0.5);
    driving_.ground.tick = tick;
    return written_to(tapes_, driving_);
  }

  std::vector<double> numbers_at(std::uint64_t tick) {
    const ground::Wind wind = at(tick);
    std::vector<double> numbers = {driving_.state.wind.u_m_s,    driving_.state.wind.v_m_s,
                                   driving_.state.reading_age_s, view_.from_deg(),
                                   shaping_.report().speed_m_s,  estimator_.turbulence().intensity};
    for (const double x_m : {-30.0, 0.0, 12.0}) {
      const Vector here = wind.at(*station_gusts(), x_m, 5.0 - x_m);
      numbers.insert(numbers.end(), {here.u_m_s, here.v_m_s});
    }
    for (std::size_t i = 0; i < heard_; ++i) numbers.push_back(estimator_.report(i).age_s);
    return numbers;
  }

  static constexpr std::size_t kSources = 4;

 private:
  static blend::Settings blend_settings(std::shared_ptr<turbulence::SiteSpectrum> site, std::size_t sources) {
    blend::Settings settings;
    settings.gustiness = 0.3;
    settings.reach_m = 15.0;
    settings.return_after_s = 3.0;
    settings.site = std::move(site);
    settings.sources = {{.priority = 1, .fits_site = true},
                        {.priority = 1, .has_place = true, .east_m = 25.0, .value = ReadingValue::kUnknown},
                        {.is_relative = true, .priority = 1},
                        {.priority = 2, .unchanged_for_s = 20.0}};
    settings.sources.resize(sources);
    return settings;
  }

  static shaping::WindShapingSettings shaping_settings() {
    return {.floor_m_s = 4.0,
            .site = {.median_m_s = 6.0},
            .over_s = 10.0,
            .gusts = 1.5,
            .ceiling = {.from_m_s = 8.0, .most_m_s = 12.0},
            .fade_s = 8.0};
  }

  /// A fast anemometer that is silent for a while, a coarse vane, a microphone, and a slow one without a vane.
  static std::optional<Reading> reading_of(std::size_t source, std::uint64_t tick, MonoTime now) {
    constexpr std::uint64_t kEvery[kSources] = {15, 60, 6, 240};
    if (tick % kEvery[source] != source) return std::nullopt;
    const std::uint64_t second = tick / kTicks_hz;
    if (source == 0 && second % 40 >= 22 && second % 40 < 32) return std::nullopt;
    const Vector wind = scripted_wind(tick + 17 * source);
    Reading reading;
    reading.time = {now, UtcTime(std::chrono::seconds(second))};
    reading.speed_m_s = speed_of(wind);
    if (source == 0) reading.direction_deg = direction_from_deg(wind);
    if (source == 1) reading.direction_deg = 22.5 * std::floor(direction_from_deg(wind) / 22.5);
    if (source == 1) reading.gust_m_s = 1.5 * reading.speed_m_s;
    return reading;
  }

  std::size_t heard_;
  MonoTime begin_;
  std::shared_ptr<turbulence::SiteSpectrum> site_;
  blend::BlendedEstimator estimator_;
  shaping::WindShaping shaping_;
  ground::WindTapes tapes_;
  ViewWind view_{270.0};
  ground::DrivingWind driving_;
};

MonoTime time_of(std::uint64_t tick, MonoTime begin) {
  return begin + from_seconds(static_cast<double>(tick) / static_cast<double>(kTicks_hz));
}

class WindSnapshotOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(WindSnapshotOnEachRow);

/// Saved at moments of the sensors' and the hand's wind; loaded by a fresh one, and by one that has had another wind.
TEST_P(WindSnapshotOnEachRow, GoesOnWithTheSameBits) {
  WindChain saved(GetParam());
  std::uint64_t tick = 0;
  for (const std::uint64_t at_s : {10U, 25U, 37U, 63U}) {
    for (; tick < at_s * kTicks_hz + 7; ++tick) saved.at(tick);
    const auto snapshot = save_snapshot(saved, kMadeOf);
    WindChain fresh(GetParam());
    WindChain used(GetParam());
    for (std::uint64_t other = 1000; other < 1400; ++other) used.at(other);
    const auto loaded = load_snapshot(fresh, kMadeOf, snapshot);
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(load_snapshot(used, kMadeOf, snapshot));
    EXPECT_EQ(save_snapshot(fresh, kMadeOf), snapshot);
    for (const std::uint64_t end = tick + 300; tick < end; ++tick) {
      const std::vector<double> numbers = saved.numbers_at(tick);
      ASSERT_EQ(fresh.numbers_at(tick), numbers) << "tick " << tick;
      ASSERT_EQ(used.numbers_at(tick), numbers) << "tick " << tick;
    }
    EXPECT_EQ(save_snapshot(fresh, kMadeOf), save_snapshot(saved, kMadeOf));
  }
}

/// Of numbers_at().
constexpr std::size_t kBeforePlaces = 6;

/// As after a restart with more sensors: while they are silent, nothing changes.
TEST_P(WindSnapshotOnEachRow, GoesOnWithMoreSources) {
  for (const std::size_t before : {1U, 2U, 3U}) {
    WindChain saved(GetParam(), {}, before);
    std::uint64_t tick = 0;
    for (; tick < 15 * kTicks_hz; ++tick) saved.at(tick);
    WindChain more(GetParam());
    ASSERT_TRUE(load_snapshot(more, kMadeOf, save_snapshot(saved, kMadeOf)));
    more.hear(before);
    for (const std::uint64_t end = tick + 300; tick < end; ++tick) {
      const std::vector<double> numbers = saved.numbers_at(tick);
      const std::vector<double> with_more = more.numbers_at(tick);
      ASSERT_EQ(with_more.size(), numbers.size());
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        // The second source brings a place of its own, by whose absent wind that of the first is interpolated.
        const bool is_at_a_place = i >= kBeforePlaces && i < kBeforePlaces + 6;
        const double most = before == 1 && is_at_a_place ? 0.03 : 1e-9;
        ASSERT_NEAR(with_more[i], numbers[i], most) << "tick " << tick << ", number " << i << ", after " << before;
      }
    }
    EXPECT_FALSE(load_snapshot(saved, kMadeOf, save_snapshot(more, kMadeOf))) << "fewer";
  }
}

/// As after a start of the machine: its clock begins anew.
TEST(WindSnapshot, GoesOnOnAnotherClock) {
  const MonoTime later(std::chrono::hours(1000));
  WindChain saved(kBaseSimdRow, later);
  for (std::uint64_t tick = 0; tick < 1000; ++tick) saved.at(tick);
  const auto snapshot = save_snapshot(saved, kMadeOf, time_of(1000, later));
  WindChain loaded(kBaseSimdRow);
  ASSERT_TRUE(load_snapshot(loaded, kMadeOf, snapshot, time_of(1000, {})));
  for (std::uint64_t tick = 1000; tick < 1300; ++tick) ASSERT_EQ(loaded.numbers_at(tick), saved.numbers_at(tick));
}

TEST(WindSnapshot, DamagedIsRefusedAndChangesNothing) {
  WindChain saved(kBaseSimdRow);
  for (std::uint64_t tick = 0; tick < 1500; ++tick) saved.at(tick);
  const auto snapshot = save_snapshot(saved, kMadeOf);
  WindChain chain(kBaseSimdRow);
  const auto before = save_snapshot(chain, kMadeOf);
  EXPECT_FALSE(load_snapshot(chain, kMadeOf + 1, snapshot));
  EXPECT_FALSE(load_snapshot(chain, kMadeOf, std::span(snapshot).first(snapshot.size() / 2)));
  const math::RandomStream random(7, math::stream_id("damage"));
  for (std::uint64_t i = 0; i < 20; ++i) {
    auto damaged = snapshot;
    damaged[static_cast<std::size_t>(random.uniform(i) * static_cast<double>(damaged.size()))] ^= 0x55U;
    EXPECT_FALSE(load_snapshot(chain, kMadeOf, damaged));
  }
  EXPECT_EQ(save_snapshot(chain, kMadeOf), before);
}

/// Damage that the checksum does not see: what is loaded moves on without harm.
TEST(WindSnapshot, RandomStateIsRefusedOrGoesOn) {
  WindChain saved(kBaseSimdRow);
  for (std::uint64_t tick = 0; tick < 1500; ++tick) saved.at(tick);
  const auto snapshot = save_snapshot(saved, kMadeOf);
  const auto state = opened_snapshot(snapshot, kMadeOf).value();
  const math::RandomStream random(9, math::stream_id("damage"));
  WindChain chain(kBaseSimdRow);
  for (std::uint64_t i = 0; i < 40; ++i) {
    std::vector<std::uint8_t> damaged(state.begin(), state.end());
    for (std::uint64_t k = 0; k < 3; ++k) {
      // Half of it near the start, where the sources are: most of the bytes are tapes.
      const double end = static_cast<double>(k == 0 ? damaged.size() : damaged.size() / 20);
      damaged[static_cast<std::size_t>(random.uniform(8 * i + 2 * k) * end)] =
          static_cast<std::uint8_t>(255.0 * random.uniform(8 * i + 2 * k + 1));
    }
    load_snapshot(chain, kMadeOf, closed_snapshot(damaged, kMadeOf));
    for (std::uint64_t tick = 1500; tick < 1530; ++tick) chain.at(tick);
  }
}

}  // namespace
}  // namespace yuragi::wind
