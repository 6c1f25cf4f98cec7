#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::wire::lead {

/// The version of the layout of a tick's bytes. Another version of the motion (kMotionVersion) is refused, too.
inline constexpr std::uint16_t kWindTickVersion = 1;

/// An order to show or hide a scene, which is carried out just before the tick that it comes with.
struct TickCue {
  std::uint32_t scene = 0;  ///< its index, in the order of the configuration
  bool shown = true;
  bool hide_others = false;
  double over_s = 0.0;  ///< duration of the fade

  void list_state(StatePass& pass) {
    pass(scene, shown, hide_others);
    pass.within(over_s, 0.0, StatePass::kLargest);
  }
};

/// Everything that goes into the poses of one tick, besides the configuration: with the same state before it, and the
/// same configuration, a daemon on any machine computes the same poses, bit for bit.
struct WindTick {
  static constexpr std::size_t kMaxCues = 8;

  /// Of a run of the leader. The larger one is the later one, whoever leads.
  std::uint64_t epoch = 0;
  /// The number of the period of the animation that ends with this tick. It rises from epoch to epoch, too.
  std::uint64_t number = 0;
  /// How many periods the tick takes, more than 1 if the leader has skipped some: the tick before is `number -
  /// periods`.
  std::uint32_t periods = 1;
  UtcTime utc{};                     ///< when the leader made it, by the leader's clock
  wind::ground::DrivingWind wind{};  ///< shaped; `ground.tapes` and `ground.tick` are the reader's own
  std::size_t cue_count = 0;
  std::array<TickCue, kMaxCues> cues{};

  void list_state(StatePass& pass);
};

/// The most that a tick may take: a longer one after a halt of the leader.
inline constexpr std::uint32_t kMaxTickPeriods = 1000;
inline constexpr std::size_t kMaxWindTick_bytes = 16UL * 1024;

/// The bytes of a tick: about 1 kB, and 1 kB more for each place of measurement. Allocates. Thread-safe.
std::vector<std::uint8_t> encode(const WindTick& tick);

/// The reverse. `now`: the moment of this machine that takes the place of the one of the tick's wind. Trusts nothing:
/// every number is finite and in its range, and the checksum agrees; otherwise the failure (kBadData) has a clause
/// without a subject, as of opened_snapshot(). Allocates nothing if it succeeds. Thread-safe.
Result<WindTick, Failure> decode_wind_tick(std::span<const std::uint8_t> bytes, MonoTime now);

}  // namespace yuragi::wire::lead
