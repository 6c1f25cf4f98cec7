#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "daemon/animation/animation.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::offline {

/// The scenes' states in a folder, one for each minute of a replay's log time, so that a replay that begins further on
/// need not step the scenes from the beginning: from a state they go on with the same bits. A file that is damaged, of
/// another version of the motion, or of anything else counts as none. None is deleted. Thread-safe: no.
class KeptStates {
 public:
  static constexpr Nanoseconds kEvery = std::chrono::minutes(1);

  /// Looks for the last state before `begin`, a log time. `made_of`: the hash of all that the poses follow from. Makes
  /// the folder, and fails (kCannotCreate) if it cannot be one.
  static Result<KeptStates, Failure> open(const std::filesystem::path& folder, std::uint64_t made_of,
                                          Nanoseconds begin);

  /// The number of ticks that need not be stepped; 0: there is no state.
  std::uint64_t first_ticks() const noexcept { return first_ticks_; }
  /// Loads the state after these ticks. `now`: the moment of the last of them.
  Result<void, Failure> load(animation::Animation& animation, MonoTime now);

  /// Keeps the state after so many ticks of a replay, if a minute begins there. `log_time`: of the last of them, which
  /// was at `now`. Replaces the file of that minute, which may be damaged. The failure names the file.
  Result<void, Failure> keep(animation::Animation& animation, std::uint64_t ticks, Nanoseconds log_time, MonoTime now);

 private:
  KeptStates(std::filesystem::path folder, std::uint64_t made_of) : folder_(std::move(folder)), made_of_(made_of) {}

  std::filesystem::path folder_;
  std::uint64_t made_of_;
  std::uint64_t first_ticks_ = 0;
  std::string first_;          ///< the state, until it is loaded
  Nanoseconds next_ = kEvery;  ///< the log time of the next one to keep
};

}  // namespace yuragi::daemon::tools::offline
