#pragma once

#include <functional>
#include <vector>

#include "daemon/animation/animation.hpp"
#include "daemon/settings/config.hpp"

namespace yuragi {

/// The I/O thread's side of showing and hiding scenes: it knows what is shown, judges who may change that ([stream]
/// control), hands what is to be done to the animation, and says what came of it. What is seen at the moment, midway in
/// a fade, only the animation knows.
///
/// Thread-safe: no.
class SceneDirector {
 public:
  /// Hands a cue over to the animation; false where it has no room for more.
  using SendCue = std::function<bool(const SceneCue&)>;

  SceneDirector(const Config& config, SendCue send_cue);

  /// Does what a client asks for, or says why not. `is_local`: it asks from this machine.
  wire::ControlReply handle(const wire::Control& control, bool is_local);

 private:
  wire::ControlReply refuse(std::string why) const;

  ControlPermission allowed_;
  std::vector<wire::SceneState> scenes_;
  SendCue send_cue_;
};

}  // namespace yuragi
