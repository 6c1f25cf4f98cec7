#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "daemon/animation/animation.hpp"
#include "engine/base/spsc_ring.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/lead/wind_tick.hpp"

namespace yuragi::daemon::animation {

/// The cue of a leader's tick, for this animation.
inline SceneCue scene_cue_of(const wire::lead::TickCue& cue) noexcept {
  return {.scene = cue.scene, .shown = cue.shown, .hide_others = cue.hide_others, .over_s = cue.over_s};
}

/// An order to save the state of the animation, or to load it, between two of its steps.
struct StateOrder {
  enum class Kind : std::uint8_t { kSave, kLoad };

  Kind kind = Kind::kSave;
  std::uint64_t number = 0;         ///< of the tick after which the state is or was
  std::vector<std::uint8_t> state;  ///< as StatePass has it; for kSave empty, with the room that it takes
  std::vector<std::uint8_t> shown;  ///< afterwards, for each scene: is it shown? Made with this size
  bool is_done = false;             ///< false: the scenes are being exchanged, or the bytes do not fit
};

/// The steps of an animation whose wind has numbers: a leader's, which all that follow it make, too. The I/O thread
/// hands over ticks ahead of time, each with the moment at which it is due; the animation's thread makes each of them
/// once, in their order, so that all machines have the same poses after the same number.
///
/// If a tick is missing when it is due, the last wind goes on: the animation never waits. Its poses are then no longer
/// the leader's (is_exact is false), until a state of the leader is loaded; what is shown does not jump
/// (SettlingPoses). What is late, by a halt of the machine or after such a state, is caught up with by two ticks at a
/// time. Without a leader the daemon's own wind is used, under numbers that continue.
///
/// push(), order(), take_finished(), use_own_wind(): for the I/O thread. step(): for the animation's thread,
/// realtime-safe but for saving and loading, which take some ms and allocate nothing. position(): for any thread.
class LedSteps {
 public:
  /// `number`: the number of the last step before the first one. `delay`: from the making of a tick to its playing.
  LedSteps(std::uint64_t number, double rate_hz, Nanoseconds delay);
  ~LedSteps();
  LedSteps(const LedSteps&) = delete;
  LedSteps& operator=(const LedSteps&) = delete;

  /// `is_own`: this daemon leads. With the first tick of another epoch the number becomes that tick's. False if the
  /// queue is full: the tick is lost.
  bool push(MonoTime due, const wire::lead::WindTick& tick, bool is_own);
  /// From this place in the queue on the daemon's own wind is used, until the next tick. False if the queue is full.
  bool use_own_wind();
  /// Has the state saved or loaded at this place in the queue. False, and `order` stays, while another one is carried
  /// out or the queue is full. One that is over and was not taken is dropped.
  bool order(std::unique_ptr<StateOrder>& order);
  /// The order that was carried out, once.
  std::unique_ptr<StateOrder> take_finished() noexcept;

  struct Position {
    std::uint64_t number = 0;  ///< of the last step
    bool is_led = false;       ///< by a leader's wind, or by its last one
    bool is_exact = false;     ///< the poses are the leader's: every tick since a state was loaded was made
    std::uint64_t epoch = 0;   ///< of the last tick
    std::uint64_t made = 0, without_tick = 0, too_late = 0;  ///< ticks made; steps in the last wind; ticks left out
    double behind_s = 0.0;                                   ///< how late the last tick was made
  };
  Position position() const noexcept;

  /// What a frame after the steps is of.
  struct Stepped {
    bool is_new = true;                 ///< false: no tick is due yet, the poses are those of before
    std::uint64_t number = 0;           ///< it goes back by some ticks when a state is loaded
    std::optional<UtcTime> utc;         ///< when it is played, by the leader's clock; nullopt: not led
    const wind::State* wind = nullptr;  ///< valid until the next call
  };
  /// Makes the ticks that are due at `now`; without a leader one step of `periods` in `own`.
  Stepped step(Animation& animation, const wind::ground::DrivingWind& own, MonoTime now,
               std::uint64_t periods) noexcept;

 private:
  /// A tick, or if there is one an order, which it owns; neither: the own wind.
  struct Next {
    MonoTime due{};
    bool is_tick = false, is_own = false;
    StateOrder* order = nullptr;
    wire::lead::WindTick tick{};
  };

  bool make_due(Animation& animation, MonoTime now) noexcept;
  bool make(Animation& animation) noexcept;
  void carry_out(Animation& animation, std::unique_ptr<StateOrder> order) noexcept;
  void advance(Animation& animation, const wind::ground::DrivingWind& wind, std::uint64_t periods) noexcept;
  void publish() noexcept;

  const double rate_hz_;
  const Nanoseconds period_, delay_;
  SpscRing<Next> queue_;
  bool is_ordered_ = false;  ///< of the I/O thread
  std::atomic<StateOrder*> finished_{nullptr};

  // Of the animation's thread.
  Next next_;  ///< taken from the queue, not yet due
  bool has_next_ = false;
  Position at_;
  MonoTime last_due_{};
  wind::ground::DrivingWind wind_;  ///< of the last tick
  UtcTime utc_{};

  // What others see of it.
  std::atomic<std::uint64_t> number_{0}, epoch_{0}, made_{0}, without_tick_{0}, too_late_{0};
  std::atomic<bool> is_led_{false}, is_exact_{false};
  std::atomic<double> behind_s_{0.0};
};

}  // namespace yuragi::daemon::animation
