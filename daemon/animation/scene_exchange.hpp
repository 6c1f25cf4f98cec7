#pragma once

#include <memory>
#include <vector>

#include "daemon/animation/animation_loop.hpp"
#include "daemon/animation/scene_director.hpp"

namespace yuragi::daemon::animation {

/// The I/O thread's side of exchanging the scenes while the animation runs.
///
///     worker: change = make_scene_change(*present, config)    takes its time, may throw
///     I/O:    begin(change); from now on the director acts on the new scenes
///     I/O:    for each frame taken: new_scenes(frame.generation) goes to the clients first, then the frame
///     I/O:    take_finished() after each frame; while is_changing() no other change is made
///
/// Thread-safe: no. Waits for nothing.
class SceneExchange {
 public:
  /// `animation`: is read here only, before its loop starts. The others must outlive this.
  SceneExchange(const Animation& animation, Loop& loop, SceneDirector& director);

  /// What the next change is made from, by any thread. Not while is_changing().
  const std::shared_ptr<const SceneRoster>& present() const noexcept { return present_; }

  /// Returns true while a change is carried out: until the leaving scenes have faded out.
  bool is_changing() const noexcept { return loop_.is_changing(); }

  /// Hands over a change that was made from present(). False, and `change` stays as it is, if another one is being
  /// carried out, or too many cues wait: try again at the next tick.
  bool begin(std::unique_ptr<SceneChange>& change);

  /// The Scenes message for the clients, if a frame of this generation is the first that needs it; otherwise null.
  std::shared_ptr<const wire::Bytes> new_scenes(std::uint64_t generation);

  /// The change that is over, once: to be freed, which takes a moment, on any thread. Null otherwise.
  std::unique_ptr<SceneChange> take_finished() noexcept { return loop_.take_finished_change(); }

 private:
  Loop& loop_;
  SceneDirector& director_;
  std::shared_ptr<const SceneRoster> present_;
  std::vector<SceneChange::Message> messages_;  // of lists of which no frame was taken yet
};

}  // namespace yuragi::daemon::animation
