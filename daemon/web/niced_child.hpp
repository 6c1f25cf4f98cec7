#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/base/time.hpp"
#include "engine/platform/child_process.hpp"

namespace yuragi::daemon::web {

/// What a program has printed, and how it ended.
struct ChildOutput {
  std::optional<platform::ChildEnd> end = {};  ///< nullopt: it was ended here, because of `why`
  std::string why = {};
  std::string printed = {};     ///< on standard output
  std::string complaints = {};  ///< on standard error: the last kMaxComplaints of it
};

/// A program that prints more is ended.
inline constexpr std::size_t kMaxPrinted_bytes = 1UL << 20;
inline constexpr std::size_t kMaxComplaints_bytes = 4096;

/// How far a child stands back from the animation.
enum class Niceness : std::uint8_t {
  kAwaited,  ///< short work, whose answer somebody waits for: behind the animation, before all that is idle
  kLowest,   ///< work of minutes: what processor and disk have left
};

/// Runs a program behind the animation, at a priority that is the calling thread's from then on, and waits for its end.
/// It is killed, with the programs that it started, after `time`, when `stop` is requested, and with the
/// calling thread. Throws std::system_error if it cannot be started.
/// `input`: what it reads; `look`: gets what it has printed so far, whenever that is more.
ChildOutput run_niced(Niceness niceness, std::vector<std::string> command, Nanoseconds time,
                      const std::stop_token& stop, const std::string& input = {},
                      const std::function<void(const std::string&)>& look = {});

/// What went wrong, for a person: its last complaint, or how it ended. Empty if its exit code is 0. Pure.
std::string failure_of(const ChildOutput& output);

}  // namespace yuragi::daemon::web
