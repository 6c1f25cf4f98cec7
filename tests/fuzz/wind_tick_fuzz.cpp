#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "engine/base/snapshot.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/wire/lead/wind_tick.hpp"

// Hostile ticks of wind: raw bytes, and damage to a good tick under a good checksum. What is accepted moves a scene,
// whose pose stays finite.

namespace {

using namespace yuragi;

constexpr std::size_t kState = 16;  ///< where a snapshot's state begins

/// With one place of measurement.
std::vector<std::uint8_t> good_tick() {
  wire::lead::WindTick tick{.epoch = 1, .number = 1};
  tick.wind.stroke.pen_count = 1;
  return encode(tick);
}

std::uint64_t made_of(const std::vector<std::uint8_t>& tick) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < 8; ++i) number |= std::uint64_t{tick[8 + i]} << (8 * i);
  return number;
}

std::vector<std::uint8_t> damaged(std::vector<std::uint8_t> tick, std::span<const std::uint8_t> damage) {
  const std::uint64_t mark = made_of(tick);
  std::vector<std::uint8_t> state(tick.begin() + kState, tick.end() - 4);
  for (; damage.size() >= 3; damage = damage.subspan(3)) {
    const std::size_t place = damage[0] + (std::size_t{damage[1]} << 8U);
    state[place % state.size()] = damage[2];
  }
  return closed_snapshot(state, mark);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<std::uint8_t> good = good_tick();
  static wind::ground::WindTapes tapes;
  static const auto scene = [] {
    const scenes::Description& kind = *scenes::scene_table().front();
    return kind.make(ParameterValues::resolve(kind.parameters, {}).value(), {.seed = 1});
  }();
  if (size == 0) return 0;
  const std::span input(data + 1, size - 1);
  const auto tick = data[0] % 2 == 0 ? wire::lead::decode_wind_tick(input, {})
                                     : wire::lead::decode_wind_tick(damaged(good, input), {});
  if (!tick) return 0;
  scene->tick(written_to(tapes, tick->wind), 1.0 / 60.0);
  pose::for_each_array(scene->pose(), [](std::span<const float> array) {
    for (const float value : array) {
      if (!std::isfinite(value)) std::abort();
    }
  });
  return 0;
}
