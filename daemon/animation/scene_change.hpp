#pragma once

#include <vector>

#include "daemon/animation/scene_list.hpp"

namespace yuragi::daemon::animation {

/// How long scenes that give way to others fade out, and those others in.
inline constexpr double kSceneChangeFade_s = 2.0;

/// The change from the present scenes to those of another configuration, made beforehand with all memory that the
/// animation's thread needs for it, and owned by that thread while it is carried out (Animation::begin_change()).
///
/// A scene whose kind, parameters, place and seed are the same is kept. One that is new, or made again, begins hidden
/// in its rest pose and fades in; one that is removed, or was made again, fades out. Meanwhile there are both; then a
/// second change of the list takes away what has left. If both together are larger than the stream allows, what leaves
/// fades out first, and the list changes once. What is shown stays shown, by the scene's name, unless the
/// configuration's `shown` of it changes.
struct SceneChange {
  /// The initial state of one scene of `roster`.
  struct Start {
    StagedScene* scene = nullptr;
    double wind_gain = 1.0;
    const StagedScene* shown_like = nullptr;  ///< shown or hidden as this one was; null: by `shown`
    bool shown = true;
  };
  /// The Scenes message that clients need before the first frame of a list.
  struct Message {
    std::uint64_t generation = 0;
    std::shared_ptr<const wire::Bytes> bytes;
  };

  // For the thread that made it or hands it over; never changes.
  std::shared_ptr<const SceneRoster> roster;  ///< the scenes after it
  std::vector<Message> messages;              ///< empty if clients need not know of the change
  std::size_t kept = 0, made = 0, leaving_count = 0;
  double reach_m = 0.0;        ///< of `roster`, as Animation::reach_m()
  std::size_t node_count = 0;  ///< of `roster`

  // For the animation. The lists that it replaces are put here, to be freed elsewhere.
  std::unique_ptr<SceneList> both;  ///< with those that leave; null: not needed
  std::unique_ptr<SceneList> last;
  std::vector<Start> starts;
  std::vector<std::shared_ptr<StagedScene>> leaving;
  double fade_s = kSceneChangeFade_s;
  bool is_over = false;

  /// Begins the fades, and sets the gains. Realtime-safe.
  void begin_fades() noexcept;
  bool has_faded_out() const noexcept;
};

/// Makes the change from `present` to the scenes of `next`, whose gusts stay those of `present`. It takes as long as
/// making scenes: for any thread but the animation's and the one of I/O, while both work on. Throws
/// settings::ConfigError if the scenes of `next` are larger than the stream allows, and what making a scene throws.
std::unique_ptr<SceneChange> make_scene_change(const SceneRoster& present, const settings::Config& next,
                                               double fade_s = kSceneChangeFade_s);

}  // namespace yuragi::daemon::animation
