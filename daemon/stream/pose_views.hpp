#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/stream/transport.hpp"
#include "engine/wire/thinner.hpp"

namespace yuragi::daemon::stream {

/// The newest scenes and frame as clients of one Thinning get them. A frame is thinned out when the first of them needs
/// it, once for all of them. A flag of 30,000 joints is 86 Mbit/s in full, and 0.8 with every 8th column and row at
/// 30 Hz. Thread-safe: no.
class PoseView {
 public:
  explicit PoseView(wire::Thinning thinning) : thinning_(std::move(thinning)) {}

  const wire::Thinning& thinning() const noexcept { return thinning_; }
  const SharedBytes& scenes() const noexcept { return scenes_; }

  /// Returns true if there is a frame of these scenes already.
  bool has_frame() const noexcept { return whole_ != nullptr; }
  /// Counts the frames that were set, from 1.
  std::uint64_t sequence() const noexcept { return sequence_; }
  SharedBytes frame();

 private:
  friend class PoseViews;
  void set_scenes(const SharedBytes& scenes);
  void set_frame(const SharedBytes& frame);

  wire::Thinning thinning_;
  std::unique_ptr<const wire::Thinner> thinner_;  // null: everything is wanted
  SharedBytes scenes_;
  SharedBytes whole_, thinned_;
  std::uint64_t sequence_ = 0;
};

/// The views of all clients: one for each Thinning, as long as a client holds it. Thread-safe: no.
class PoseViews {
 public:
  /// An encoded wire::Scenes: from now on frames are of these, and there is none yet.
  void set_scenes(SharedBytes scenes);
  /// An encoded wire::Frame.
  void set_frame(SharedBytes frame);

  /// What was set last; null: nothing yet.
  const SharedBytes& scenes() const noexcept { return scenes_; }

  std::shared_ptr<PoseView> view(const wire::Thinning& thinning);

  /// Returns why a client cannot have this Thinning of the scenes, for a person: it names one that does not exist, with
  /// the names that exist. nullopt: it can.
  std::optional<std::string> refusal(const wire::Thinning& thinning) const;

 private:
  SharedBytes scenes_, frame_;
  std::vector<std::string> names_;  // of the scenes; each once
  std::vector<std::weak_ptr<PoseView>> views_;
};

}  // namespace yuragi::daemon::stream
