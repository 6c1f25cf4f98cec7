// Each fault that a HID station can suffer, with every simulated station that suffers it: the state is right within its
// time, nothing false is published, and the readings return by themselves.
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/hid_bench.hpp"

namespace yuragi::drivers::hid {
namespace {

using simulators::core::FaultKind;
using test::HidBench;

constexpr double kFaultBegins_s = 300.0;
constexpr double kFaultEnds_s = 540.0;
constexpr double kOvershoot_s = 1.5;
constexpr double kSteady_m_s = 8.6;

/// How soon a family notices, and how soon it is back.
struct Patience {
  std::string_view model;
  double notices_s;  ///< from the fault's beginning until the driver says that something is wrong
  double returns_s;  ///< from the fault's end until the next reading
};
// WMR100: four winds missed, or its own minute of silence, or 90 s without wind. WMR300: 15 s without wind. The others
// are asked every 48, 18 and 33 s. Back: one interval, the longest wait for opening, and the retries between.
constexpr std::array<Patience, 6> kPatience = {{{"wmr100", 95.0, 40.0},
                                                {"wmr300", 19.0, 25.0},
                                                {"fineoffset", 70.0, 75.0},
                                                {"fineoffset-wh3080", 70.0, 75.0},
                                                {"acurite", 20.0, 40.0},
                                                {"te923", 37.0, 50.0}}};

/// A station that suffers `kind` from minute 5 to minute 9.
class FaultyBench : public HidBench {
 public:
  FaultyBench(std::string_view model, FaultKind kind) : test::HidBench(model) {
    bus.fault = [kind](double time_s) {
      return time_s >= kFaultBegins_s && time_s < kFaultEnds_s ? std::optional(kind) : std::nullopt;
    };
  }

  /// Runs until that time, or a little longer: what waits for the station is not cut off.
  void run_until(double time_s) { run_for(time_s - bus.now_s()); }

  std::size_t refusals(decode::Refusal why) const { return static_cast<std::size_t>(sink.count(why)); }
};

bool suffers(std::string_view model, FaultKind kind) {
  const auto device = simulators::usb::make_hid_station(model);
  return std::ranges::count(device->known_faults(), kind) > 0;
}

void expect_the_steady_wind(const RecordingSink& sink) {
  for (const wind::Reading& reading : sink.readings) {
    EXPECT_NEAR(reading.speed_m_s, kSteady_m_s, 0.12);
    EXPECT_EQ(reading.direction_deg.value_or(225.0), 225.0);
  }
}

/// The fault leaves nothing to publish: said so in time, counted as `why` (any, if empty), back by itself.
void expect_silence_and_return(FaultKind kind, std::optional<decode::Refusal> why) {
  int stations = 0;
  for (const Patience& patience : kPatience) {
    if (!suffers(patience.model, kind)) continue;
    SCOPED_TRACE(patience.model);
    ++stations;
    FaultyBench bench(patience.model, kind);
    bench.run_until(kFaultBegins_s - kOvershoot_s);
    ASSERT_GT(bench.readings(), 5U);
    ASSERT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
    const std::size_t refusals_before = bench.sink.refusals.size();
    const std::size_t such_before = bench.refusals(why.value_or(decode::Refusal::kTimeout));

    // What was said before the fault may still come, once.
    bench.run_until(kFaultBegins_s + 1.0);
    const std::size_t before = bench.readings();
    bench.run_until(kFaultBegins_s + patience.notices_s);
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
    EXPECT_FALSE(bench.sink.last_detail().empty());
    bench.run_until(kFaultEnds_s - kOvershoot_s);
    EXPECT_LE(bench.readings(), before);
    EXPECT_GT(bench.sink.refusals.size(), refusals_before);
    if (why) {
      EXPECT_GT(bench.refusals(*why), such_before) << name_of(*why);
    }
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);

    const std::size_t during = bench.readings();
    bench.run_until(kFaultEnds_s + patience.returns_s);
    EXPECT_GT(bench.readings(), during);
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
    expect_the_steady_wind(bench.sink);
  }
  EXPECT_GE(stations, 1);
}

TEST(HidFault, Silence) {
  expect_silence_and_return(FaultKind::kSilence, decode::Refusal::kTimeout);
}

TEST(HidFault, Garbage) {
  expect_silence_and_return(FaultKind::kGarbage, std::nullopt);
}

TEST(HidFault, Partial) {
  expect_silence_and_return(FaultKind::kPartial, decode::Refusal::kTooShort);
}

TEST(HidFault, BadChecksum) {
  expect_silence_and_return(FaultKind::kBadChecksum, decode::Refusal::kBadChecksum);
}

TEST(HidFault, Late) {
  expect_silence_and_return(FaultKind::kLate, decode::Refusal::kTimeout);
}

TEST(HidFault, Split) {
  // The right bytes, with pauses between them: nothing is lost.
  int stations = 0;
  for (const Patience& patience : kPatience) {
    if (!suffers(patience.model, FaultKind::kSplit)) continue;
    SCOPED_TRACE(patience.model);
    ++stations;
    FaultyBench bench(patience.model, FaultKind::kSplit);
    bench.run_until(kFaultBegins_s - kOvershoot_s);
    const std::size_t before = bench.readings();
    const std::size_t refusals_before = bench.sink.refusals.size() - bench.refusals(decode::Refusal::kNotMine);
    bench.run_until(kFaultEnds_s - kOvershoot_s);
    EXPECT_GE(bench.readings(), before + 3U);
    EXPECT_EQ(bench.sink.refusals.size() - bench.refusals(decode::Refusal::kNotMine), refusals_before);
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
    EXPECT_EQ(bench.bus.opened, 1);
    expect_the_steady_wind(bench.sink);
  }
  EXPECT_EQ(stations, 4);
}

/// The station says something else than the wind, and says it well: that is for others to judge.
void expect_unchanged(FaultKind kind, double sent_m_s, double tolerance_m_s) {
  for (const Patience& patience : kPatience) {
    SCOPED_TRACE(patience.model);
    FaultyBench bench(patience.model, kind);
    // It freezes at 8.6 m/s; the true wind goes on and is 3 m/s.
    bench.bus.wind = [](double time_s) {
      return simulators::core::PlayedMoment{time_s < kFaultBegins_s ? kSteady_m_s : 3.0, 225.0};
    };
    bench.run_until(kFaultBegins_s + 60.0);
    const std::size_t before = bench.readings();
    bench.run_until(kFaultEnds_s - kOvershoot_s);
    ASSERT_GT(bench.readings(), before + 2U);
    for (std::size_t i = before; i < bench.readings(); ++i) {
      EXPECT_NEAR(bench.sink.readings[i].speed_m_s, sent_m_s, tolerance_m_s);
    }
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
    bench.run_until(kFaultEnds_s + 60.0);
    EXPECT_NEAR(bench.sink.readings.back().speed_m_s, 3.0, 0.13);
    EXPECT_EQ(bench.bus.opened, 1);
  }
}

TEST(HidFault, Freeze) {
  expect_unchanged(FaultKind::kFreeze, kSteady_m_s, 0.12);
}

TEST(HidFault, Spike) {
  expect_unchanged(FaultKind::kSpike, 55.0, 0.12);
}

TEST(HidFault, Unplug) {
  for (const Patience& patience : kPatience) {
    SCOPED_TRACE(patience.model);
    FaultyBench bench(patience.model, FaultKind::kUnplug);
    bench.run_until(kFaultBegins_s - kOvershoot_s);
    ASSERT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
    bench.run_until(kFaultBegins_s + 2.0);
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
    const std::size_t before = bench.readings();
    bench.run_until(kFaultEnds_s - kOvershoot_s);
    EXPECT_EQ(bench.readings(), before);
    bench.run_until(kFaultEnds_s + patience.returns_s);
    EXPECT_GT(bench.readings(), before);
    EXPECT_EQ(bench.bus.opened, 2);
    EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
    expect_the_steady_wind(bench.sink);
  }
}

}  // namespace
}  // namespace yuragi::drivers::hid
