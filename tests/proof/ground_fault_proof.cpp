// What comes over the ground when the wind turns, dies and comes back, and when the sensor fails: nothing that would be
// seen, at no place.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"
#include "tests/proof/estimated_wind.hpp"
#include "tests/proof/sonic_record.hpp"

namespace yuragi::proof {
namespace {

constexpr double kGroundTick_s = 1.0 / 60.0;
constexpr double kBegin_s = 60.0;    ///< until then an estimator that has just begun is on its way
constexpr double kChange_s = 300.0;  ///< here things happen
constexpr double kChangeEnd_s = 660.0;
constexpr double kRecordEnd_s = 1800.0;
constexpr double kSilenceEnd_s = kChange_s + 100.0;
constexpr std::uint64_t kGroundSeeds = 3;
constexpr double kMaxStep = 1.5;
constexpr double kMaxSpeed = 1.3;

/// How a wind has moved.
struct Motion {
  double largest_step_m_s = 0.0;
  double highest_speed_m_s = 0.0;

  void add(const Motion& other) {
    largest_step_m_s = std::max(largest_step_m_s, other.largest_step_m_s);
    highest_speed_m_s = std::max(highest_speed_m_s, other.highest_speed_m_s);
  }
};

/// The wind as a scene in one place feels it.
class FeltWind {
 public:
  FeltWind(const scenes::Placement& placement, std::shared_ptr<const wind::turbulence::GustNoise> gusts)
      : wind_(placement, std::move(gusts)) {}

  void step(const wind::ground::Wind& ground) {
    const wind::Vector before = value();
    wind_.step(ground, kGroundTick_s);
    motion_.add({speed_of(value() - before), wind_.speed_m_s()});
  }
  void forget() { motion_ = {}; }
  const Motion& motion() const { return motion_; }

 private:
  wind::Vector value() const { return {wind_.east_m_s(), -wind_.south_m_s()}; }

  scenes::Wind wind_;
  Motion motion_;
};

/// A sensor at the windward edge of a meadow, and what scenes feel in its middle, in its corners and at the edge. What
/// the sensor says is believed whatever it is: no judge stands before it.
class Ground {
 public:
  Ground(double size_m, std::uint64_t seed)
      : estimator_(1, {.climate = {.seed = seed}, .reach_m = size_m / std::numbers::sqrt2}, shared_noise()),
        at_sensor_({}, nullptr) {
    for (const auto& [east, south] : std::array<std::pair<int, int>, 5>{{{0, 0}, {-1, -1}, {-1, 1}, {1, -1}, {1, 1}}}) {
      places_.emplace_back(scenes::Placement{.x_m = east * size_m / 2, .z_m = south * size_m / 2}, shared_noise());
    }
  }

  void estimate(const std::vector<wind::Reading>& readings, double from_s, double to_s) {
    const MonoTime from(from_seconds(from_s));
    auto next = std::ranges::lower_bound(readings, from, {}, [](const wind::Reading& said) { return said.time.mono; });
    const auto ticks = std::lround((to_s - from_s) / kGroundTick_s);
    for (long tick = 0; tick < ticks; ++tick) {
      const MonoTime now = from + from_seconds(static_cast<double>(tick) * kGroundTick_s);
      for (; next != readings.end() && next->time.mono <= now; ++next) estimator_.accept(0, *next);
      const wind::State state = estimator_.advance(now);
      const wind::ground::Wind ground = over_the_ground();
      for (FeltWind& place : places_) place.step(ground);
      at_sensor_.step(state.wind);
    }
  }

  void forget() {
    for (FeltWind& place : places_) place.forget();
    at_sensor_.forget();
  }
  const Motion& at_sensor() const { return at_sensor_.motion(); }
  Motion at_places() const {
    Motion most;
    for (const FeltWind& place : places_) most.add(place.motion());
    return most;
  }

 private:
  /// The wind of this tick, to be read at places.
  wind::ground::Wind over_the_ground() { return written_to(tapes_, {{}, estimator_.ground(), estimator_.stroke()}); }

  wind::blend::BlendedEstimator estimator_;
  wind::ground::WindTapes tapes_;
  std::vector<FeltWind> places_;
  FeltWind at_sensor_;
};

/// Changes the record from kChange_s on: each wind is turned and made stronger by what `change` says of the time since.
using WindChange = std::function<std::pair<double, double>(double since_s, double speed_m_s)>;

SonicRecord changed(SonicRecord record, const WindChange& change) {
  for (std::size_t i = 0; i < record.samples.size(); ++i) {
    const double since_s = static_cast<double>(i) / record.rate_hz - kChange_s;
    if (since_s < 0.0) continue;
    wind::Vector& wind = record.samples[i];
    const auto [turn_rad, factor] = change(since_s, speed_of(wind));
    const double sine = std::sin(turn_rad);
    const double cosine = std::cos(turn_rad);
    wind = factor * wind::Vector{cosine * wind.u_m_s - sine * wind.v_m_s, sine * wind.u_m_s + cosine * wind.v_m_s};
  }
  return record;
}

WindChange turn_in(double duration_s) {
  return [duration_s](double since_s, double) {
    return std::pair(std::numbers::pi * std::min(since_s / duration_s, 1.0), 1.0);
  };
}

/// Down to 0.1 m/s in 20 s, three minutes of that, and up in 5 s.
std::pair<double, double> calm_between(double since_s, double speed_m_s) {
  constexpr double kDown_s = 20.0;
  constexpr double kCalm_s = 180.0;
  constexpr double kUp_s = 5.0;
  const double down = std::clamp(1.0 - since_s / kDown_s, 0.0, 1.0);
  const double up = std::clamp((since_s - kDown_s - kCalm_s) / kUp_s, 0.0, 1.0);
  return {0.0, std::max({down, up, 0.1 / std::max(speed_m_s, 0.1)})};
}

struct GroundCase {
  std::string name;
  std::vector<wind::Reading> readings;
  bool is_stronger_wind = false;  ///< more than the record has was told
};

std::vector<GroundCase> cases_of(const SonicRecord& record, double interval_s) {
  std::vector<GroundCase> cases = {
      {"turns by 180 degrees in 60 s", block_means(changed(record, turn_in(60.0)), interval_s)},
      {"turns by 180 degrees in 1 s", block_means(changed(record, turn_in(1.0)), interval_s)},
      {"calm, then wind", block_means(changed(record, calm_between), interval_s)},
      {"silence of 100 s", block_means(record, interval_s)},
      {"one reading of 40 m/s", block_means(record, interval_s), true},
  };
  const auto time_of = [](const wind::Reading& said) { return said.time.mono; };
  const MonoTime silence(from_seconds(kChange_s));
  const MonoTime end(from_seconds(kSilenceEnd_s));
  std::erase_if(cases[3].readings,
                [&](const wind::Reading& said) { return time_of(said) >= silence && time_of(said) < end; });
  std::ranges::lower_bound(cases[4].readings, silence, {}, time_of)->speed_m_s = 40.0;
  return cases;
}

/// Record, interval of the sensor, size of the meadow.
class GroundFaults : public testing::TestWithParam<std::tuple<int, double, double>> {};

TEST_P(GroundFaults, NoPlaceMovesMuchMoreThanItMovesAnyway) {
  const auto [number, interval_s, size_m] = GetParam();
  const SonicRecord record = sonic_or_synthetic(number);
  const std::vector<wind::Reading> readings = block_means(record, interval_s);
  const std::vector<GroundCase> cases = cases_of(record, interval_s);

  Motion usual;
  std::vector<Motion> at_sensor(cases.size());
  std::vector<Motion> at_places(cases.size());
  for (std::uint64_t seed = 1; seed <= kGroundSeeds; ++seed) {
    Ground ground(size_m, seed);
    ground.estimate(readings, 0.0, kBegin_s);
    ground.forget();
    ground.estimate(readings, kBegin_s, kChange_s);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      Ground other = ground;
      other.forget();
      other.estimate(cases[i].readings, kChange_s, kChangeEnd_s);
      at_sensor[i].add(other.at_sensor());
      at_places[i].add(other.at_places());
    }
    ground.estimate(readings, kChange_s, kRecordEnd_s);
    usual.add(ground.at_places());
  }

  fmt::print(
      "| record {}, {:g} s, {:g} m | largest step, m/s | at the sensor | of the normal | highest speed | of the normal "
      "|\n",
      number, interval_s, size_m);
  fmt::print("| --- | --- | --- | --- | --- | --- |\n| normal motion | {:.3f} | | | {:.2f} | |\n",
             usual.largest_step_m_s, usual.highest_speed_m_s);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double step = at_places[i].largest_step_m_s / std::max(usual.largest_step_m_s, at_sensor[i].largest_step_m_s);
    const double speed = at_places[i].highest_speed_m_s / usual.highest_speed_m_s;
    fmt::print("| {} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.2f} |\n", cases[i].name, at_places[i].largest_step_m_s,
               at_sensor[i].largest_step_m_s, step, at_places[i].highest_speed_m_s, speed);
    EXPECT_LE(step, kMaxStep) << cases[i].name;
    if (cases[i].is_stronger_wind) continue;
    EXPECT_LE(speed, kMaxSpeed) << cases[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Records, GroundFaults,
                         testing::Combine(testing::Values(0, 1), testing::Values(0.1, 1.0, 14.0),
                                          testing::Values(7.0, 60.0)));

}  // namespace
}  // namespace yuragi::proof
