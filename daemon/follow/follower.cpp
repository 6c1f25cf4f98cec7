#include "daemon/follow/follower.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace yuragi::daemon::follow {
namespace {

/// How long before its time the tick after a gap is handed to the animation: between two steps of this thread.
constexpr int kHandedEarly = 2;
constexpr Nanoseconds kAskLeaderFirst = std::chrono::milliseconds(250), kAskLeaderLongest = std::chrono::seconds(2);
/// Some replies' times, so that none is asked for twice in vain.
constexpr Nanoseconds kAskTicks = std::chrono::milliseconds(60);
constexpr Nanoseconds kAskStateFirst = std::chrono::seconds(2), kAskStateLongest = std::chrono::seconds(10);
/// A state of which a part has come so lately is on its way.
constexpr Nanoseconds kArriving = std::chrono::seconds(1);

}  // namespace

void Follower::Asking::ask(MonoTime now, Nanoseconds first, Nanoseconds longest) {
  wait = asked ? std::min(2 * wait, longest) : first;
  asked = now;
}

Follower::Follower(PictureMakeup makeup, Nanoseconds delay, animation::LedSteps& steps, Ask ask, Listener listener)
    : makeup_(std::move(makeup)),
      play_out_(makeup_.rate_hz, delay),
      steps_(steps),
      ask_(std::move(ask)),
      listener_(std::move(listener)),
      period_(from_seconds(1.0 / makeup_.rate_hz)),
      silent_after_(std::max<Nanoseconds>(kSilentAfter, kSilentTicks * period_)) {}

/// One that has come, or a part of it.
void Follower::forget_state() {
  arriving_.reset();
  to_load_.reset();
}

void Follower::take_tick(std::span<const std::uint8_t> bytes, MonoTime now) {
  const auto tick = wire::lead::decode_wind_tick(bytes, now);
  if (!tick) {
    heard_unknown_ = now;
    return refuse();
  }
  if (tick->epoch < play_out_.epoch()) {
    if (!is_silent(now)) return refuse();
    other_ = {.epoch = tick->epoch, .since = now};
    return;
  }
  heard_ = now;
  if (!is_of_the_present(*tick, now)) return;
  switch (play_out_.take(*tick, now)) {
    case PlayOut::Taken::kNew:
      ++counts_.ticks;
      break;
    case PlayOut::Taken::kKnown:
      break;
    case PlayOut::Taken::kNotOfIt:
      // After a long silence the numbers have gone on.
      play_out_.begin(tick->epoch);
      play_out_.take(*tick, now);
      break;
  }
}

/// Of a leader that has introduced itself. Another one is asked for that, and forgotten if it does not.
bool Follower::is_of_the_present(const wire::lead::WindTick& tick, MonoTime now) {
  if (tick.epoch == play_out_.epoch()) {
    if (other_ && now - other_->since > silent_after_) other_.reset();
    return is_in_wind_;
  }
  if (!other_ || tick.epoch > other_->epoch) other_ = {.epoch = tick.epoch, .since = now};
  return false;
}

void Follower::take_reply(std::span<const std::uint8_t> bytes, MonoTime now) {
  const auto reply = decode_reply(bytes);
  if (!reply) return refuse();
  std::visit([this, now](const auto& held) { take(held, now); }, *reply);
}

void Follower::take(const Introduction& introduction, MonoTime now) {
  const bool is_awaited = other_ && other_->epoch == introduction.epoch;
  if (introduction.epoch < latest_epoch() && !(is_awaited && is_silent(now))) return refuse();
  other_.reset();
  leader_ = {};
  leaders_ = introduction.makeup;
  leaders_delay_s_ = introduction.delay_s;
  differences_ = wind_differences(*leaders_, makeup_);
  is_in_wind_ = differences_.empty();
  if (is_in_wind_) differences_ = scene_differences(*leaders_, makeup_);
  if (introduction.epoch == play_out_.epoch()) return;
  play_out_.begin(introduction.epoch);
  ticks_ = state_ = {};
  forget_state();
}

void Follower::take(const Ticks& ticks, MonoTime now) {
  for (const Bytes& bytes : ticks.ticks) {
    const auto tick = wire::lead::decode_wind_tick(bytes, now);
    if (!tick) return refuse();
    if (is_in_wind_ && play_out_.take(*tick, now) == PlayOut::Taken::kNew) ++counts_.repaired;
  }
}

void Follower::take(const StatePart& part, MonoTime now) {
  if (!has_same_scenes() || part.epoch != play_out_.epoch() || part.made_of != makeup_.hash() || to_load_ ||
      is_loading_)
    return;
  if (!arriving_ || arriving_->number != part.number || arriving_->total_bytes != part.total_bytes)
    arriving_ = {
        .number = part.number, .total_bytes = part.total_bytes, .arrived_bytes = 0, .latest = now, .parts = {}};
  if (!arriving_->parts.emplace(part.first_byte, part.bytes).second) return;
  arriving_->latest = now;
  arriving_->arrived_bytes += part.bytes.size();
  if (arriving_->arrived_bytes < arriving_->total_bytes) return;
  auto order = std::make_unique<animation::StateOrder>();
  order->kind = animation::StateOrder::Kind::kLoad;
  order->number = part.number;
  order->shown.resize(makeup_.scenes.size());
  bool is_whole = true;
  for (const auto& [first_byte, bytes] : arriving_->parts) {
    is_whole = is_whole && first_byte == order->state.size();
    order->state.insert(order->state.end(), bytes.begin(), bytes.end());
  }
  arriving_.reset();
  if (!is_whole) return refuse();
  to_load_ = std::move(order);
  load(now);
}

/// Between the ticks that were handed over already and those that follow the state.
void Follower::load(MonoTime now) {
  if (!to_load_) return;
  // It is of a tick that is not played yet: it waits for that.
  if (to_load_->number > play_out_.newest()) return;
  play(now);
  if (!play_out_.go_back_to(to_load_->number)) {
    // It waits until that tick is played; one that is too old, or before a gap, is asked for again.
    if (to_load_->number < play_out_.played()) to_load_.reset();
    return;
  }
  if (steps_.order(to_load_)) is_loading_ = true;
}

void Follower::play(MonoTime now) {
  while (const wire::lead::WindTick* tick = play_out_.next(now + kHandedEarly * period_)) {
    uses_own_wind_ = false;
    for (std::size_t i = 0; i < tick->cue_count; ++i) listener_.cued(animation::scene_cue_of(tick->cues[i]));
    if (!steps_.push(play_out_.due(tick->number), *tick, false)) return;
  }
}

const wind::ground::DrivingWind* Follower::wind() const noexcept {
  const wire::lead::WindTick* const last = uses_own_wind_ ? nullptr : play_out_.last();
  return last == nullptr ? nullptr : &last->wind;
}

void Follower::ask_for_ticks(MonoTime now) {
  if (!ticks_.is_due(now)) return;
  for (const PlayOut::Gap& gap : play_out_.gaps(now)) {
    if (gap.to == 0) break;
    ticks_.ask(now, kAskTicks, kAskTicks);
    ask_(
        encode(Question{.about = Question::About::kTicks, .epoch = play_out_.epoch(), .from = gap.from, .to = gap.to}));
  }
}

void Follower::ask_for_state(MonoTime now) {
  const animation::LedSteps::Position at = steps_.position();
  const bool is_needed = has_same_scenes() && at.is_led && !(at.is_exact && at.epoch == play_out_.epoch());
  if (!is_needed || to_load_ || is_loading_) {
    if (!is_needed) state_ = {};
    return;
  }
  const bool is_coming = arriving_ && now - arriving_->latest < kArriving;
  if (at.epoch != play_out_.epoch() || is_coming || !state_.is_due(now)) return;
  state_.ask(now, kAskStateFirst, kAskStateLongest);
  ask_(encode(Question{.about = Question::About::kState, .epoch = play_out_.epoch()}));
}

void Follower::ask_who_leads(MonoTime now) {
  const bool is_unknown = heard_unknown_ && now - *heard_unknown_ < silent_after_ && !is_in_wind_;
  if (!other_ && leaders_ && !is_unknown) return;
  if (!leader_.is_due(now)) return;
  leader_.ask(now, kAskLeaderFirst, kAskLeaderLongest);
  ask_(encode(Question{}));
}

void Follower::advance(MonoTime now) {
  if (const auto finished = is_loading_ ? steps_.take_finished() : nullptr) {
    is_loading_ = false;
    if (finished->is_done) {
      ++counts_.states;
      listener_.loaded(finished->shown);
    }
  }
  if (heard_ || heard_unknown_ || other_) ask_who_leads(now);
  if (is_silent(now) || !is_in_wind_) {
    if (!uses_own_wind_ && steps_.use_own_wind()) uses_own_wind_ = true;
    state_ = {};
    return;
  }
  play(now);
  ask_for_ticks(now);
  load(now);
  ask_for_state(now);
}

void Follower::leave() {
  play_out_.begin(0);
  leaders_.reset();
  other_.reset();
  is_in_wind_ = false;
  uses_own_wind_ = true;
  forget_state();
  is_loading_ = false;
  leaders_delay_s_.reset();
  leader_ = ticks_ = state_ = {};
}

void Follower::set_makeup(PictureMakeup makeup) {
  makeup_ = std::move(makeup);
  leaders_.reset();
  forget_state();
}

Follower::Phase Follower::phase(MonoTime now) const {
  if (leaders_ && !is_in_wind_) return Phase::kDiffers;
  if (!heard_) return Phase::kNoLeader;
  if (is_silent(now)) return Phase::kSilent;
  const animation::LedSteps::Position at = steps_.position();
  if (!leaders_ || !at.is_led || at.epoch != play_out_.epoch()) return Phase::kJoining;
  if (!differences_.empty()) return Phase::kSameWind;
  return at.is_exact ? Phase::kSamePicture : Phase::kJoining;
}

}  // namespace yuragi::daemon::follow
