#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/animation/led_steps.hpp"
#include "daemon/follow/play_out.hpp"
#include "daemon/follow/questions.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::follow {

/// Makes an animation's steps of the ticks that come from a leader: asks who leads and compares what the pictures
/// follow from, asks for ticks that were lost on the way, and for the state of the leader's scenes until its own poses
/// are the same. Belongs to the I/O thread; time is a parameter, and nothing waits.
///
/// Ticks of another leader or epoch count only once that leader has introduced itself. Those of an older epoch do not
/// count while the present leader is heard: they may be a replay. Afterwards they may be of a leader that was started
/// again with a wrong clock. All that comes in is hostile until it is decoded.
class Follower {
 public:
  /// The leader is silent when it is not heard for this long, or for kSilentTicks if these take longer: the last wind
  /// goes on until then, then the own one.
  static constexpr std::chrono::seconds kSilentAfter{2};
  static constexpr int kSilentTicks = 8;

  /// Asks the leader. Never waits.
  using Ask = std::function<void(const Bytes& question)>;
  /// What becomes of the scenes by another daemon's will.
  struct Listener {
    std::function<void(const std::vector<std::uint8_t>& shown)> loaded;  ///< a state: is each scene shown?
    std::function<void(const animation::SceneCue& cue)> cued;
  };

  Follower(PictureMakeup makeup, Nanoseconds delay, animation::LedSteps& steps, Ask ask, Listener listener);

  void take_tick(std::span<const std::uint8_t> bytes, MonoTime now);
  void take_reply(std::span<const std::uint8_t> bytes, MonoTime now);
  /// At each step of the own wind: plays what is due soon, and asks.
  void advance(MonoTime now);

  /// Does not follow any more: this daemon leads.
  void leave();
  /// Its scenes are others from now on.
  void set_makeup(PictureMakeup makeup);

  /// The latest epoch of which a tick was heard, whoever leads in it.
  std::uint64_t latest_epoch() const noexcept { return std::max(play_out_.epoch(), other_ ? other_->epoch : 0); }
  std::uint64_t newest_number() const noexcept { return play_out_.newest(); }
  /// When a tick was heard last, by which a leader is missed; nullopt: never.
  std::optional<MonoTime> heard() const noexcept { return heard_; }

  /// The wind of the tick that was played last; null while it is not in a leader's wind. Valid until the next call.
  const wind::ground::DrivingWind* wind() const noexcept;

  enum class Phase : std::uint8_t {
    kNoLeader,  ///< none was heard
    kDiffers,   ///< it cannot move in the leader's wind: see differences()
    kJoining,   ///< in its wind; the poses are not yet the same
    kSamePicture,
    kSameWind,  ///< in its wind, with other scenes: see differences()
    kSilent,    ///< the leader is not heard any more
  };
  Phase phase(MonoTime now) const;
  /// Between this daemon and the leader, as texts.
  const std::vector<std::string>& differences() const noexcept { return differences_; }
  /// The delay with which the leader plays; nullopt: not known.
  std::optional<double> leaders_delay_s() const noexcept { return leaders_delay_s_; }

  struct Counts {
    std::uint64_t ticks = 0, refused = 0;  ///< taken; what is not of a leader, or damaged
    std::uint64_t repaired = 0;            ///< asked for; ticks that came as a reply
    std::uint64_t states = 0;              ///< that were loaded
  };
  const Counts& counts() const noexcept { return counts_; }

 private:
  /// A question that is asked again until it is answered, each time after a longer while.
  struct Asking {
    std::optional<MonoTime> asked = std::nullopt;
    Nanoseconds wait{};
    bool is_due(MonoTime now) const { return !asked || now - *asked >= wait; }
    void ask(MonoTime now, Nanoseconds first, Nanoseconds longest);
  };

  bool is_silent(MonoTime now) const noexcept { return !heard_ || now - *heard_ > silent_after_; }
  bool is_of_the_present(const wire::lead::WindTick& tick, MonoTime now);
  void ask_who_leads(MonoTime now);
  void take(const Introduction& introduction, MonoTime now);
  void take(const Ticks& ticks, MonoTime now);
  void take(const StatePart& part, MonoTime now);
  void take(const NodeList& /*list*/, MonoTime /*now*/) {}  // for `yuragi fleet`
  void play(MonoTime now);
  void ask_for_ticks(MonoTime now);
  void ask_for_state(MonoTime now);
  void load(MonoTime now);
  void refuse() noexcept { ++counts_.refused; }
  void forget_state();
  bool has_same_scenes() const noexcept { return is_in_wind_ && differences_.empty(); }

  PictureMakeup makeup_;
  PlayOut play_out_;
  animation::LedSteps& steps_;
  Ask ask_;
  Listener listener_;
  const Nanoseconds period_, silent_after_;

  std::optional<PictureMakeup> leaders_;  ///< of the epoch that is played, or that differs
  std::optional<double> leaders_delay_s_;
  bool is_in_wind_ = false;  ///< its ticks are played
  std::vector<std::string> differences_;
  /// Another epoch, whose leader has not introduced itself yet.
  struct Other {
    std::uint64_t epoch = 0;
    MonoTime since{};
  };
  std::optional<Other> other_;
  std::optional<MonoTime> heard_, heard_unknown_;  ///< a tick; one that cannot be read, as of another version
  bool uses_own_wind_ = true;

  Asking leader_, ticks_, state_;
  /// A state that arrives in parts, in any order.
  struct Arriving {
    std::uint64_t number = 0, total_bytes = 0, arrived_bytes = 0;
    MonoTime latest{};
    std::map<std::uint64_t, Bytes> parts;  ///< by their first byte
  };
  std::optional<Arriving> arriving_;
  std::unique_ptr<animation::StateOrder> to_load_;
  bool is_loading_ = false;
  Counts counts_;
};

}  // namespace yuragi::daemon::follow
