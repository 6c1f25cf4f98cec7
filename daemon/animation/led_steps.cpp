#include "daemon/animation/led_steps.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "daemon/animation/tick_schedule.hpp"

namespace yuragi::daemon::animation {
namespace {

/// Ticks that may wait besides those of the delay: of some seconds, after a state that is as old.
constexpr std::size_t kWaiting = 512;
/// The most that are made at a time: so what is late is caught up with, and no step takes much longer.
constexpr int kMostAtOnce = 2;
/// A tick that is this late is left out: this machine is too slow to catch up.
constexpr Nanoseconds kTooLate = std::chrono::seconds(5);
/// How many periods after the last tick the next one is missing. Between 1 and 2 it is only not due yet.
constexpr double kMissingAfter = 2.5;

}  // namespace

LedSteps::LedSteps(std::uint64_t number, double rate_hz, Nanoseconds delay)
    : rate_hz_(rate_hz),
      period_(from_seconds(1.0 / rate_hz)),
      delay_(delay),
      queue_(kWaiting + static_cast<std::size_t>(seconds(delay) * rate_hz)) {
  at_.number = number;
  publish();
}

LedSteps::~LedSteps() {
  queue_.drain([](const Next& next) { const std::unique_ptr<StateOrder> owned(next.order); });
  if (has_next_) delete next_.order;
  take_finished();
}

bool LedSteps::push(MonoTime due, const wire::lead::WindTick& tick, bool is_own) {
  return queue_.push({.due = due, .is_tick = true, .is_own = is_own, .order = nullptr, .tick = tick});
}

bool LedSteps::use_own_wind() {
  return queue_.push({});
}

bool LedSteps::order(std::unique_ptr<StateOrder>& order) {
  if (is_ordered_) take_finished();
  if (is_ordered_ || !queue_.push({.due = {}, .is_tick = false, .is_own = false, .order = order.get(), .tick = {}}))
    return false;
  static_cast<void>(order.release());  // the queue owns it
  is_ordered_ = true;
  return true;
}

std::unique_ptr<StateOrder> LedSteps::take_finished() noexcept {
  std::unique_ptr<StateOrder> finished(finished_.exchange(nullptr, std::memory_order_acquire));
  if (finished) is_ordered_ = false;
  return finished;
}

LedSteps::Stepped LedSteps::step(Animation& animation, const wind::ground::DrivingWind& own, MonoTime now,
                                 std::uint64_t periods) noexcept {
  bool is_new = make_due(animation, now);
  if (!is_new && !at_.is_led) {
    advance(animation, own, periods);
    is_new = true;
  } else if (!is_new && now - last_due_ > from_seconds(kMissingAfter / rate_hz_)) {
    // The last wind goes on, and its moment with it.
    last_due_ += static_cast<Nanoseconds::rep>(periods) * period_;
    utc_ += static_cast<Nanoseconds::rep>(periods) * period_;
    at_.is_exact = false;
    at_.without_tick += periods;
    advance(animation, wind_, periods);
    is_new = true;
  }
  publish();
  Stepped stepped{.is_new = is_new, .number = at_.number, .utc = {}, .wind = at_.is_led ? &wind_.state : &own.state};
  if (at_.is_led) stepped.utc = utc_ + delay_;
  return stepped;
}

/// Returns true if a step was made.
bool LedSteps::make_due(Animation& animation, MonoTime now) noexcept {
  int made = 0;
  while (made < kMostAtOnce) {
    if (!has_next_ && !queue_.pop(next_)) break;
    has_next_ = true;
    if (next_.is_tick && next_.due > now) break;
    has_next_ = false;
    if (next_.order != nullptr) {
      carry_out(animation, std::unique_ptr<StateOrder>(std::exchange(next_.order, nullptr)));
    } else if (!next_.is_tick) {
      at_.is_led = at_.is_exact = false;
    } else if (now - next_.due > kTooLate) {
      ++at_.too_late;
      at_.is_exact = false;
    } else if (make(animation)) {
      at_.behind_s = seconds(now - next_.due);
      ++made;
    }
  }
  return made > 0;
}

/// Makes the tick of `next_`. Returns false if its number has passed.
bool LedSteps::make(Animation& animation) noexcept {
  const wire::lead::WindTick& tick = next_.tick;
  if (tick.epoch != at_.epoch) {
    at_.epoch = tick.epoch;
    at_.number = tick.number - tick.periods;
    at_.is_exact = next_.is_own;
  }
  if (tick.number <= at_.number) return false;
  const std::uint64_t periods = tick.number - at_.number;
  if (periods != tick.periods) at_.is_exact = false;
  for (std::size_t i = 0; i < tick.cue_count; ++i) {
    animation.cue(scene_cue_of(tick.cues[i]));
  }
  wind_ = tick.wind;
  utc_ = tick.utc;
  last_due_ = next_.due;
  at_.is_led = true;
  ++at_.made;
  advance(animation, wind_, periods);
  return true;
}

void LedSteps::carry_out(Animation& animation, std::unique_ptr<StateOrder> order) noexcept {
  if (order->kind == StateOrder::Kind::kSave) {
    order->number = at_.number;
    order->is_done = animation.save_state(order->state, wind_.state.time);
  } else if (animation.load_state(order->state, wind_.state.time)) {
    order->is_done = true;
    at_.number = order->number;
    at_.is_led = at_.is_exact = true;
  }
  const std::size_t scenes = std::min(order->shown.size(), animation.roster()->scenes.size());
  for (std::size_t i = 0; i < scenes; ++i) order->shown[i] = animation.roster()->scenes[i]->fade.is_shown() ? 1 : 0;
  finished_.store(order.release(), std::memory_order_release);
}

void LedSteps::advance(Animation& animation, const wind::ground::DrivingWind& wind, std::uint64_t periods) noexcept {
  animation.step(wind, step_s(periods, rate_hz_), periods);
  at_.number += periods;
}

void LedSteps::publish() noexcept {
  number_.store(at_.number, std::memory_order_relaxed);
  epoch_.store(at_.epoch, std::memory_order_relaxed);
  made_.store(at_.made, std::memory_order_relaxed);
  without_tick_.store(at_.without_tick, std::memory_order_relaxed);
  too_late_.store(at_.too_late, std::memory_order_relaxed);
  is_led_.store(at_.is_led, std::memory_order_relaxed);
  is_exact_.store(at_.is_exact, std::memory_order_relaxed);
  behind_s_.store(at_.behind_s, std::memory_order_relaxed);
}

LedSteps::Position LedSteps::position() const noexcept {
  return {.number = number_.load(std::memory_order_relaxed),
          .is_led = is_led_.load(std::memory_order_relaxed),
          .is_exact = is_exact_.load(std::memory_order_relaxed),
          .epoch = epoch_.load(std::memory_order_relaxed),
          .made = made_.load(std::memory_order_relaxed),
          .without_tick = without_tick_.load(std::memory_order_relaxed),
          .too_late = too_late_.load(std::memory_order_relaxed),
          .behind_s = behind_s_.load(std::memory_order_relaxed)};
}

}  // namespace yuragi::daemon::animation
