#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/settings/control_permission.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/shaping/wind_shaping.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::service {

/// What people have set by hand: the wind, the blackout and the camera, each until its time is over or somebody ends
/// it. Checks the permission ([stream] control) and every number. Nothing of it outlives the daemon.
///
/// Pure: the time is a parameter, of the steady clock, so that a wrong date changes nothing. Thread-safe: no.
class HandDirector {
 public:
  static constexpr double kMinHold_s = 1.0;

  /// `cameras`: the names of [[camera]], in their order.
  HandDirector(settings::ControlPermission allowed, std::vector<std::string> cameras);

  /// Changes who may set something.
  void allow(settings::ControlPermission allowed) { allowed_ = allowed; }
  /// Other cameras from now on. The one that is set stays so if there is still one of its name.
  void set_cameras(std::vector<std::string> cameras);

  /// Carries out a client's command, in place of what was set before; the reply has the reason for a refusal, and what
  /// is set now. `is_local`: the client is on this machine.
  wire::ControlReply handle(const wire::HandCommand& command, bool is_local, MonoTime now);

  /// Forgets what has ended by now, and returns a sentence about each, once.
  std::vector<std::string> take_ended(MonoTime now);

  wire::ByHand status(MonoTime now) const;
  wind::shaping::ByHand shaping(MonoTime now) const;
  /// The index of the camera that is set; nullopt: the one by the time of day.
  std::optional<std::size_t> camera(MonoTime now) const;

 private:
  /// Something that is set; without an end until somebody ends it.
  struct Held {
    std::optional<MonoTime> end;
    wind::shaping::HeldWind wind = {};  ///< of the wind
    std::string camera = {};            ///< of the camera: its name
  };
  static bool is_set(const std::optional<Held>& held, MonoTime now);
  static std::optional<wire::Hold> hold(const std::optional<Held>& held, MonoTime now);

  std::optional<Held>& held(wire::HandPart part);
  std::optional<std::string> mistake_in(const wire::HandCommand& command) const;

  settings::ControlPermission allowed_;
  std::vector<std::string> cameras_;
  std::optional<Held> wind_, blackout_, camera_;
};

/// What is set, in one line: "by hand: 8 m/s from 270 degrees, 42 s left; dark". Empty if nothing is.
std::string by_hand_text(const wire::ByHand& by_hand);

}  // namespace yuragi::daemon::service
