#pragma once

#include <cstdint>
#include <functional>

#include "daemon/animation/scene_director.hpp"
#include "daemon/service/reload.hpp"
#include "daemon/settings/control_permission.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::service {

/// Handles clients' requests to list and to set the values of [look] and of scenes, on the I/O thread: checks the
/// permission ([stream] control), has Reload apply them as it applies a changed file, and a scene's `shown` the
/// SceneDirector. Thread-safe: no.
class ParameterDirector {
 public:
  using Reply = std::function<void(const wire::ControlReply&)>;

  /// Both must outlive it. `scenes`: null if the daemon has none. `revision`: the first; another one than the daemon
  /// that ran before had.
  ParameterDirector(Reload& reload, animation::SceneDirector* scenes, settings::ControlPermission allowed,
                    std::uint64_t revision);

  /// Changes who may set values.
  void allow(settings::ControlPermission allowed) { allowed_ = allowed; }

  /// Carries out a request; `reply` is called once, at once or when it is done. `is_local`: the client is on this
  /// machine.
  void handle(const wire::ParameterCommand& command, bool is_local, Reply reply);

  /// Something that a ParameterReport would list has changed.
  void note_change() noexcept { ++revision_; }
  /// Sensors::parameters_revision.
  std::uint64_t revision() const noexcept { return revision_; }

 private:
  wire::ParameterReport report(const wire::ParameterCommand& command, bool is_local) const;
  std::optional<std::string> refusal(bool is_local) const;

  Reload& reload_;
  animation::SceneDirector* scenes_;
  settings::ControlPermission allowed_;
  std::uint64_t revision_;
};

}  // namespace yuragi::daemon::service
