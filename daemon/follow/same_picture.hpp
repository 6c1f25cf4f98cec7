#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::follow {

/// What a daemon's poses follow from besides the ticks, for comparing it with another daemon's: hashes, each with the
/// name that a person finds it by.
struct PictureMakeup {
  std::string software;      ///< "yuragi 1.2"; it may differ
  std::uint32_t motion = 0;  ///< kMotionVersion
  double rate_hz = 0.0;
  std::uint64_t wind = 0;  ///< of what the gusts over the ground are made of: the seed, and whether they evolve
  /// The scenes in their order, each with the hash of its kind, place and parameters.
  std::vector<std::pair<std::string, std::uint64_t>> scenes;

  /// Of all but the software: what a state of the scenes is of.
  std::uint64_t hash() const;
};

PictureMakeup makeup_of(const settings::Config& config);

/// Why a daemon with `own` cannot move in the wind of one with `leaders`, as texts without an end; empty: it can.
std::vector<std::string> wind_differences(const PictureMakeup& leaders, const PictureMakeup& own);

/// Which scenes differ, in the same way: it moves in that wind, but its picture is another one. Empty: the same.
std::vector<std::string> scene_differences(const PictureMakeup& leaders, const PictureMakeup& own);

}  // namespace yuragi::daemon::follow
