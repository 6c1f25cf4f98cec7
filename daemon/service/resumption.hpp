#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "daemon/animation/animation.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/shaping/wind_shaper.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::service {

/// Everything that a frame follows from, besides the configuration and what sensors will measure.
struct Motion {
  sensing::SensorHub& hub;
  shaping::WindShaper& shaper;
  animation::Animation& animation;

  void list_state(StatePass& pass) { pass(hub, shaper, animation); }
};

/// The file with which a daemon that is started again goes on: its first frame is the one after the last frame of the
/// run before, in the same wind, so that a picture on the wall does not jump. The time between the two runs counts as
/// none. Written at an orderly end (a signal, a restart for the page), not by a crash. Sensors may have been added at
/// the end, as the page adds them.
///
/// Belongs to the I/O thread.
class Resumption {
 public:
  /// A motion that is older is of a wind that is gone.
  static constexpr std::chrono::minutes kMaxAge{10};

  /// `file`: empty: nothing is saved or loaded.
  explicit Resumption(std::filesystem::path file) : file_(std::move(file)) {}

  /// Loads the motion, if one was saved less than kMaxAge ago under a configuration that moves in the same way. Call it
  /// just before the first step, which is at `now`. Removes the file first, so that no state can stop a second start.
  /// Logs what it did. Returns false if the motion is as it was.
  bool load(const settings::Config& config, Motion motion, MonoTime now) const;

  /// Saves the motion, while nothing steps it. A failure is logged.
  void save(const settings::Config& config, Motion motion) const;

 private:
  std::filesystem::path file_;
};

}  // namespace yuragi::daemon::service
