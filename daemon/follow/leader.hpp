#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daemon/animation/animation.hpp"
#include "daemon/animation/led_steps.hpp"
#include "daemon/follow/fleet.hpp"
#include "daemon/follow/questions.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::daemon::follow {

/// Makes the numbered ticks of a daemon that leads: for its own animation, which plays them as late as all others, and
/// for those that follow, whose questions it answers. Belongs to the I/O thread.
class Leader {
 public:
  /// Sends to a subject. Never waits.
  using Send = std::function<void(const std::string& subject, const Bytes& bytes)>;

  /// For how long a tick can be asked for.
  static constexpr std::chrono::seconds kKept{60};
  /// The largest number of followers that are remembered as waiting for a state. More get it, too: what several wait
  /// for is sent to all.
  static constexpr std::size_t kMaxWaiting = 2;
  /// The most that is sent as introductions and as ticks once more, so that no follower's questions fill the link.
  /// Further questions are refused; followers ask again.
  static constexpr double kMaxReplies_bytes_s = 8e6;

  /// The subjects of ticks, and of a state that several followers have asked for.
  struct Subjects {
    std::string ticks, states;
  };

  /// `state_bytes`: the size of the animation's state.
  Leader(PictureMakeup makeup, double rate_hz, Nanoseconds delay, std::size_t state_bytes, Subjects subjects,
         animation::LedSteps& steps, Send send);

  /// Begins an epoch that is later than `after`, with a number above `number`.
  void begin_epoch(UtcTime now, std::uint64_t after, std::uint64_t number);
  std::uint64_t epoch() const noexcept { return epoch_; }
  std::uint64_t number() const noexcept { return number_; }

  /// With the next tick. False if too many wait.
  bool cue(const animation::SceneCue& cue);

  /// Makes the ticks of the last `periods`, which end at `at`, in this wind; each is played `delay` after its time. So
  /// a halt that is shorter than the delay is not seen; after a longer one there is one tick of all periods.
  void make_ticks(const wind::ground::DrivingWind& wind, const Instant& at, std::uint32_t periods);

  /// Answers a follower. What is no question is counted.
  void answer(std::span<const std::uint8_t> question, const std::string& reply_to, MonoTime now);

  /// Goes on with a state that somebody asked for.
  void advance(MonoTime now);

  /// Takes what a node reports of itself. What is no report is counted.
  void take_report(std::span<const std::uint8_t> bytes, MonoTime now);
  /// Takes a message of the history: nodes that are not heard any more are in the list.
  void take_history(std::span<const std::uint8_t> bytes, const Instant& now);
  const Fleet& fleet() const noexcept { return fleet_; }

  /// Its scenes are others from now on: call begin_epoch() then.
  void set_makeup(PictureMakeup makeup) { makeup_ = std::move(makeup); }

  struct Counts {
    std::uint64_t questions = 0, refused = 0, repaired_ticks = 0, states = 0;
  };
  const Counts& counts() const noexcept { return counts_; }

 private:
  void make_tick(const wind::ground::DrivingWind& wind, const Instant& at, std::uint32_t periods);
  void reply(const std::string& reply_to, const Bytes& bytes);
  void send_ticks(const Question& question, const std::string& reply_to);
  void queue_state(const animation::StateOrder& saved);

  PictureMakeup makeup_;
  const double rate_hz_;
  const Nanoseconds delay_;
  std::size_t state_bytes_;
  const Subjects subjects_;
  animation::LedSteps& steps_;
  Send send_;

  std::uint64_t epoch_ = 0, number_ = 0;
  std::vector<wire::lead::TickCue> cues_;
  std::deque<std::pair<std::uint64_t, Bytes>> kept_;  ///< by number
  double reply_bytes_left_ = kMaxReplies_bytes_s;     ///< of a second's
  std::vector<std::string> waiting_;                  ///< for a state
  MonoTime saved_{};
  bool is_saving_ = false;
  /// The parts of a state: one a tick, so that it delays no tick.
  std::deque<std::pair<std::string, Bytes>> parts_;
  Fleet fleet_;
  Counts counts_;
};

}  // namespace yuragi::daemon::follow
