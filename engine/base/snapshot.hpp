#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/base/time.hpp"

namespace yuragi {

/// The version of the motion: of what a tick computes, and of what each list_state() lists. It rises with every change
/// of a golden hash (tests/golden), and a snapshot of another version is refused.
inline constexpr std::uint32_t kMotionVersion = 2;

/// A snapshot is the moving state of an object, as bytes:
///
///     "YuSn", kMotionVersion (4 bytes), made_of (8 bytes), the state (StatePass), CRC-32 of all before (4 bytes)
///
/// little-endian. FlatBuffers, as on the wire, would need a schema beside each class, and reads what other versions
/// wrote; here nothing but the same version may be read, and the object itself is the schema. `made_of`: a hash of what
/// the object was made of. Both functions are set-up work. Thread-safe: for different objects.

/// Does the checksum, the version and `made_of` agree? Returns the state's bytes; otherwise what is wrong with
/// the snapshot, as a clause without a subject ("is damaged"), because the caller names the file.
Result<std::span<const std::uint8_t>, Failure> opened_snapshot(std::span<const std::uint8_t> snapshot,
                                                               std::uint64_t made_of);
/// The reverse.
std::vector<std::uint8_t> closed_snapshot(std::span<const std::uint8_t> state, std::uint64_t made_of,
                                          std::uint32_t version = kMotionVersion);

/// The same clause for a state that does not fit.
Failure state_failure(StatePass::Problem problem);

/// Saves an object. `now`: the moment to which its moments (MonoTime) are relative. Changes nothing.
template <ListsState Object>
std::vector<std::uint8_t> save_snapshot(Object& object, std::uint64_t made_of, MonoTime now = {}) {
  std::vector<std::uint8_t> state;
  StatePass pass = StatePass::saving(state, now);
  object.list_state(pass);
  return closed_snapshot(state, made_of);
}

/// Loads it into an object that was made of the same. `now`: the moment that takes the place of the one of saving, so
/// that ages remain. A failure (kBadData, a clause like that of opened_snapshot()) leaves the object as it was.
template <ListsState Object>
Result<void, Failure> load_snapshot(Object& object, std::uint64_t made_of, std::span<const std::uint8_t> snapshot,
                                    MonoTime now = {}) {
  const auto state = opened_snapshot(snapshot, made_of);
  if (!state) return state.error();
  StatePass check = StatePass::checking(*state);
  object.list_state(check);
  if (check.problem() != StatePass::Problem::kNone) return state_failure(check.problem());
  StatePass load = StatePass::loading(*state, now);
  object.list_state(load);
  return {};
}

}  // namespace yuragi
