#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/animation/animation.hpp"
#include "daemon/settings/config.hpp"

namespace yuragi::daemon::animation {

/// Handles clients' requests to show and hide scenes, on the I/O thread: checks the permission ([stream] control),
/// sends cues to the animation, and replies with the scenes that are shown. A scene counts as shown or hidden from the
/// beginning of its fade on.
///
/// Thread-safe: no.
class SceneDirector {
 public:
  /// Sends a cue to the animation; false if its queue is full.
  using SendCue = std::function<bool(const SceneCue&)>;

  SceneDirector(const settings::Config& config, SendCue send_cue);

  /// From now on the scenes are those of `roster`, and cues refer to it. What is shown stays shown, by its name, unless
  /// the configuration's `shown` of it has changed (SceneChange).
  void follow(const SceneRoster& roster);

  /// What the animation shows and hides is what was shown and hidden here, after its state was loaded.
  void resume(const SceneRoster& roster);

  /// The same, for each scene in its order.
  void note_shown(std::span<const std::uint8_t> shown);
  /// Another daemon, which this one follows, has sent this cue to the animation.
  void note(const SceneCue& cue);

  /// Changes who may switch scenes.
  void allow(settings::ControlPermission allowed) { allowed_ = allowed; }

  /// Carries out a client's request; the reply has the reason for a refusal. `is_local`: the client is on this machine.
  wire::ControlReply handle(const wire::Control& control, bool is_local);

  /// The same for somebody who may show and hide scenes by another right than [stream] control.
  wire::ControlReply handle_permitted(const wire::Control& control);

 private:
  wire::ControlReply carry_out(const wire::Control& control, const std::optional<std::string>& refusal);
  wire::ControlReply refuse(std::string why) const;

  settings::ControlPermission allowed_;
  std::vector<wire::SceneState> scenes_;
  std::vector<bool> configured_shown_;  // one a scene
  SendCue send_cue_;
};

}  // namespace yuragi::daemon::animation
