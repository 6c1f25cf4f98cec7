// Snapshots of scenes (engine/base/snapshot.hpp), of each kind in the table and on each SIMD row: a scene that is
// loaded goes on with the bits of the one that was saved, and bytes that are not its snapshot are refused and change
// nothing.

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/snapshot.hpp"
#include "engine/math/philox.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/scripted_wind.hpp"
#include "tests/support/station_wind.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kSnapshotTick_s = 1.0 / 60.0;
constexpr std::uint64_t kTicksBefore = 120;
constexpr std::uint64_t kTicksAfter = 300;

bool has_parameter(const Description& kind, std::string_view name) {
  return std::ranges::any_of(kind.parameters, [&](const Parameter& parameter) { return parameter.name == name; });
}

/// The values of a kind as it is shipped, or with the parts that are off then; of a small scene, which is quick.
ParameterValues values_of(const Description& kind, bool is_other) {
  ParameterValues::Map given;
  if (is_other && has_parameter(kind, "hybrid")) given["hybrid"] = kind.name == "grass" ? 0.5 : 1.0;
  if (is_other && has_parameter(kind, "gusts")) given["gusts"] = std::string("own");
  if (is_other && has_parameter(kind, "form")) given["form"] = std::string("texture");
  for (const std::string_view name : {"columns", "rows", "blades_across", "blades_deep", "hairs_along", "hairs_around",
                                      "leaves", "branch_links", "twigs"}) {
    if (has_parameter(kind, name)) given[std::string(name)] = std::int64_t{16};
  }
  return ParameterValues::resolve(kind.parameters, given).value();
}

/// A scene and the hash of what it is made of.
struct Made {
  Made(const Description& kind, const ParameterValues& values, const Setup& setup)
      : scene(kind.make(values, setup)), made_of(scenes::made_of(kind.name, values, setup)) {}

  std::vector<std::uint8_t> save() { return save_snapshot(*scene, made_of); }
  Result<void, Failure> load(std::span<const std::uint8_t> snapshot) {
    return load_snapshot(*scene, made_of, snapshot);
  }
  std::string refusal(std::span<const std::uint8_t> snapshot) {
    const auto loaded = load(snapshot);
    return loaded ? "loaded" : loaded.error().message;
  }

  std::unique_ptr<Scene> scene;
  std::uint64_t made_of;
};

class SnapshotOnEachRow : public EachSimdRow {
 protected:
  /// A fresh scene, and one that has moved in another wind, go on as the saved one does. `wind_at` is called for each
  /// tick in its order.
  template <class WindAt>
  void expect_to_go_on(const Description& kind, const ParameterValues& values, const scenes::Setup& setup,
                       WindAt wind_at) {
    Made saved(kind, values, setup);
    for (std::uint64_t tick = 0; tick < kTicksBefore; ++tick) saved.scene->tick(wind_at(tick), kSnapshotTick_s);
    const std::vector<std::uint8_t> snapshot = saved.save();

    Made fresh(kind, values, setup);
    Made used(kind, values, setup);
    for (std::uint64_t tick = 0; tick < 10; ++tick) {
      wind::ground::Wind other(wind::Vector{9.0, -4.0});
      other.tick = 17 + tick;
      used.scene->tick(other, 0.02);
    }
    const auto loaded = fresh.load(snapshot);
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(used.load(snapshot));
    EXPECT_EQ(fresh.save(), snapshot);

    std::uint64_t saved_hash = pose::kPoseHashSeed;
    std::uint64_t fresh_hash = pose::kPoseHashSeed;
    std::uint64_t used_hash = pose::kPoseHashSeed;
    for (std::uint64_t tick = kTicksBefore; tick < kTicksBefore + kTicksAfter; ++tick) {
      const wind::ground::Wind wind = wind_at(tick);
      for (Made* each : {&saved, &fresh, &used}) each->scene->tick(wind, kSnapshotTick_s);
      saved_hash = pose::pose_hash(saved_hash, saved.scene->pose());
      fresh_hash = pose::pose_hash(fresh_hash, fresh.scene->pose());
      used_hash = pose::pose_hash(used_hash, used.scene->pose());
    }
    EXPECT_EQ(fresh_hash, saved_hash) << kind.name;
    EXPECT_EQ(used_hash, saved_hash) << kind.name;
    EXPECT_EQ(fresh.save(), saved.save()) << kind.name;
  }
};
YURAGI_ON_EACH_ROW(SnapshotOnEachRow);

TEST_P(SnapshotOnEachRow, EverySceneGoesOnWithTheSameBits) {
  for (const Description* kind : scene_table()) {
    for (const bool is_other : {false, true}) {
      SCOPED_TRACE(is_other ? "other values" : "default values");
      expect_to_go_on(*kind, values_of(*kind, is_other), {.seed = 1, .row = GetParam()}, scripted_wind);
    }
  }
}

TEST_P(SnapshotOnEachRow, EverySceneGoesOnInAMeasuredWindWithTheSameBits) {
  for (const Description* kind : scene_table()) {
    for (const bool is_other : {false, true}) {
      SCOPED_TRACE(is_other ? "other values" : "default values");
      StationWind wind(GetParam());
      expect_to_go_on(*kind, values_of(*kind, is_other),
                      {.seed = 1, .placement = {3.0, 0.0, -2.0, 30.0}, .row = GetParam(), .gusts = station_gusts()},
                      [&](std::uint64_t tick) { return wind.at(tick); });
    }
  }
}

/// What a row saves, any row loads: the bytes are the same.
TEST_P(SnapshotOnEachRow, TheBytesAreThoseOfTheBaseRow) {
  for (const Description* kind : scene_table()) {
    const ParameterValues values = values_of(*kind, false);
    Made here(*kind, values, {.seed = 1, .row = GetParam()});
    Made base(*kind, values, {.seed = 1, .row = kBaseSimdRow});
    for (std::uint64_t tick = 0; tick < kTicksBefore; ++tick) {
      here.scene->tick(scripted_wind(tick), kSnapshotTick_s);
      base.scene->tick(scripted_wind(tick), kSnapshotTick_s);
    }
    EXPECT_EQ(here.save(), base.save()) << kind->name;
  }
}

class SceneSnapshot : public testing::TestWithParam<const Description*> {
 protected:
  /// A small scene that moves.
  static Made moving() {
    Made made(*GetParam(), values_of(*GetParam(), false), {.seed = 1});
    for (std::uint64_t tick = 0; tick < kTicksBefore; ++tick) made.scene->tick(scripted_wind(tick), kSnapshotTick_s);
    return made;
  }
  /// With the state of a good one, and a good checksum.
  static std::vector<std::uint8_t> with_state(Made& made, const std::vector<std::uint8_t>& state) {
    return closed_snapshot(state, made.made_of);
  }
  static std::vector<std::uint8_t> state_of(Made& made) {
    const std::vector<std::uint8_t> snapshot = made.save();
    const auto state = opened_snapshot(snapshot, made.made_of).value();
    return {state.begin(), state.end()};
  }
};

INSTANTIATE_TEST_SUITE_P(Scenes, SceneSnapshot, testing::ValuesIn(scene_table().begin(), scene_table().end()),
                         [](const auto& kind) { return std::string(kind.param->name); });

TEST_P(SceneSnapshot, OfAnotherConfigurationIsRefused) {
  const std::vector<std::uint8_t> snapshot = moving().save();
  const ParameterValues values = values_of(*GetParam(), false);
  ParameterValues other = values;
  const Parameter& last = *std::ranges::find_if(
      GetParam()->parameters, [](const Parameter& it) { return std::holds_alternative<double>(it.default_value); });
  other.set(last.name, 0.9 * values.number(last.name) + 0.1 * last.max);
  std::vector<Made> others;
  others.emplace_back(*GetParam(), values, scenes::Setup{.seed = 2});
  others.emplace_back(*GetParam(), other, scenes::Setup{.seed = 1});
  others.emplace_back(*GetParam(), values, scenes::Setup{.seed = 1, .placement = {.x_m = 1.0}});
  others.emplace_back(*GetParam(), values, scenes::Setup{.seed = 1, .gusts = station_gusts()});
  for (Made& made : others) {
    const std::vector<std::uint8_t> before = made.save();
    EXPECT_EQ(made.refusal(snapshot), "is of another configuration");
    EXPECT_EQ(made.save(), before);
  }
}

TEST_P(SceneSnapshot, DamagedOrTruncatedIsRefusedAndChangesNothing) {
  const std::vector<std::uint8_t> snapshot = moving().save();
  Made made(*GetParam(), values_of(*GetParam(), false), {.seed = 1});
  const std::vector<std::uint8_t> before = made.save();
  const math::RandomStream random(7, math::stream_id("damage"));
  for (std::uint64_t i = 0; i < 200; ++i) {
    std::vector<std::uint8_t> damaged = snapshot;
    const auto place = static_cast<std::size_t>(random.uniform(2 * i) * static_cast<double>(damaged.size()));
    damaged[place] ^= static_cast<std::uint8_t>(1 + 254.0 * random.uniform(2 * i + 1));
    EXPECT_FALSE(made.load(damaged));
    EXPECT_FALSE(made.load(std::span(snapshot).first(place)));
  }
  std::vector<std::uint8_t> longer = snapshot;
  longer.push_back(0);
  EXPECT_FALSE(made.load(longer));
  EXPECT_FALSE(made.load({}));
  EXPECT_EQ(made.save(), before);
}

TEST_P(SceneSnapshot, AStateThatDoesNotFitIsRefusedAlsoWhereTheChecksumIsRight) {
  Made saved = moving();
  const std::vector<std::uint8_t> state = state_of(saved);
  Made made(*GetParam(), values_of(*GetParam(), false), {.seed = 1});
  const std::vector<std::uint8_t> before = made.save();

  std::vector<std::uint8_t> shorter = state;
  shorter.pop_back();
  EXPECT_EQ(made.refusal(with_state(made, shorter)), "is damaged: its length is wrong");
  std::vector<std::uint8_t> longer = state;
  longer.push_back(0);
  EXPECT_EQ(made.refusal(with_state(made, longer)), "is damaged: its length is wrong");

  // Each scene's state begins with its wind's, which are doubles.
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e30}) {
    std::vector<std::uint8_t> number;
    StatePass::saving(number)(bad);
    std::vector<std::uint8_t> wrong = state;
    std::ranges::copy(number, wrong.begin());
    EXPECT_EQ(made.refusal(with_state(made, wrong)), "is damaged: a number is out of its range");
  }
  EXPECT_EQ(made.save(), before);
  EXPECT_TRUE(made.load(with_state(made, state)));
}

/// Damage that the checksum does not see: what is loaded moves on without harm.
TEST_P(SceneSnapshot, RandomStateIsRefusedOrGoesOn) {
  Made saved = moving();
  const std::vector<std::uint8_t> state = state_of(saved);
  Made made(*GetParam(), values_of(*GetParam(), false), {.seed = 1});
  const math::RandomStream random(8, math::stream_id("damage"));
  for (std::uint64_t i = 0; i < 100; ++i) {
    std::vector<std::uint8_t> damaged = state;
    for (std::uint64_t k = 0; k < 4; ++k) {
      const auto place = static_cast<std::size_t>(random.uniform(16 * i + 2 * k) * static_cast<double>(damaged.size()));
      damaged[place] = static_cast<std::uint8_t>(255.0 * random.uniform(16 * i + 2 * k + 1));
    }
    const std::vector<std::uint8_t> before = made.save();
    if (!made.load(with_state(made, damaged))) {
      EXPECT_EQ(made.save(), before);
    }
    for (std::uint64_t tick = 0; tick < 3; ++tick) made.scene->tick(scripted_wind(tick), kSnapshotTick_s);
  }
}

}  // namespace
}  // namespace yuragi::scenes
