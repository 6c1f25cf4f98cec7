#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "engine/base/snapshot.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/scripted_wind.hpp"

// Hostile snapshots of scenes. The first byte of the input chooses a kind of scene, and whether the rest is raw bytes
// or damage to the state of a good snapshot, under a good checksum. A refusal changes nothing; what is loaded moves on.

namespace {

using namespace yuragi;

constexpr std::uint64_t kMadeOf = 1;

/// Small, so that a tick is quick.
struct Target {
  explicit Target(const scenes::Description& kind) {
    ParameterValues::Map given;
    for (const Parameter& parameter : kind.parameters) {
      const auto* count = std::get_if<std::int64_t>(&parameter.default_value);
      if (count != nullptr && *count > 16) given[std::string(parameter.name)] = std::int64_t{16};
      if (parameter.name == "hybrid") given["hybrid"] = 1.0;
    }
    scene = kind.make(ParameterValues::resolve(kind.parameters, given).value(), {.seed = 1});
    for (std::uint64_t tick = 0; tick < 60; ++tick) scene->tick(scripted_wind(tick), 1.0 / 60.0);
    StatePass pass = StatePass::saving(state);
    scene->list_state(pass);
  }

  std::unique_ptr<scenes::Scene> scene;
  std::vector<std::uint8_t> state;  ///< a good one
};

/// Each three bytes of `damage` are a place (little-endian) and a value.
std::vector<std::uint8_t> damaged(std::vector<std::uint8_t> state, std::span<const std::uint8_t> damage) {
  for (; damage.size() >= 3; damage = damage.subspan(3)) {
    const std::size_t place = damage[0] + (std::size_t{damage[1]} << 8U);
    state[place % state.size()] = damage[2];
  }
  return state;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::vector<Target> targets = [] {
    std::vector<Target> made;
    for (const scenes::Description* kind : scenes::scene_table()) made.emplace_back(*kind);
    return made;
  }();
  if (size == 0) return 0;
  const std::span input(data + 1, size - 1);
  Target& target = targets[data[0] / 2 % targets.size()];
  const std::vector<std::uint8_t> snapshot = data[0] % 2 == 0 ? std::vector<std::uint8_t>(input.begin(), input.end())
                                                              : closed_snapshot(damaged(target.state, input), kMadeOf);
  const std::vector<std::uint8_t> before = save_snapshot(*target.scene, kMadeOf);
  if (!load_snapshot(*target.scene, kMadeOf, snapshot)) {
    if (save_snapshot(*target.scene, kMadeOf) != before) std::abort();
    return 0;
  }
  for (std::uint64_t tick = 0; tick < 3; ++tick) target.scene->tick(scripted_wind(tick), 1.0 / 60.0);
  return 0;
}
