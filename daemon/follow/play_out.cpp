#include "daemon/follow/play_out.hpp"

#include <algorithm>

namespace yuragi::daemon::follow {
namespace {

/// Clocks of two machines differ by at most 1 part in 10,000: half a millisecond in this time.
constexpr auto kWindow = std::chrono::seconds(5);

}  // namespace

PlayOut::PlayOut(double rate_hz, Nanoseconds delay) : rate_hz_(rate_hz), delay_(delay), ticks_(kKept) {}

void PlayOut::begin(std::uint64_t epoch) {
  epoch_ = epoch;
  for (wire::lead::WindTick& tick : ticks_) tick.number = 0;
  first_ = played_ = newest_ = 0;
  quickest_.reset();
  quickest_before_.reset();
}

const wire::lead::WindTick* PlayOut::at(std::uint64_t number) const noexcept {
  const wire::lead::WindTick& tick = ticks_[number % kKept];
  return tick.number == number && number != 0 ? &tick : nullptr;
}

PlayOut::Taken PlayOut::take(const wire::lead::WindTick& tick, MonoTime arrival) {
  if (tick.epoch != epoch_ || tick.number <= tick.periods) return Taken::kNotOfIt;
  if (newest_ == 0) {
    first_ = tick.number;
    played_ = tick.number - tick.periods;
  } else if (tick.number > newest_ + wire::lead::kMaxTickPeriods) {
    return Taken::kNotOfIt;
  }
  if (at(tick.number) != nullptr || tick.number + kKept <= newest_) return Taken::kKnown;
  ticks_[tick.number % kKept] = tick;
  newest_ = std::max(newest_, tick.number);
  learn(tick.number, arrival);
  return Taken::kNew;
}

void PlayOut::learn(std::uint64_t number, MonoTime arrival) noexcept {
  const auto since_first = static_cast<double>(static_cast<std::int64_t>(number - first_));
  const MonoTime would_begin = arrival - from_seconds(since_first / rate_hz_);
  if (arrival - window_begin_ > kWindow) {
    if (arrival - window_begin_ < 2 * kWindow) quickest_before_ = quickest_;
    quickest_.reset();
    window_begin_ = arrival;
  }
  quickest_ = std::min(quickest_.value_or(would_begin), would_begin);
}

MonoTime PlayOut::due(std::uint64_t number) const noexcept {
  const MonoTime now_quickest = quickest_.value_or(MonoTime{});
  const MonoTime quickest = std::min(now_quickest, quickest_before_.value_or(now_quickest));
  const auto since_first = static_cast<double>(static_cast<std::int64_t>(number - first_));
  return quickest + delay_ + from_seconds(since_first / rate_hz_);
}

const wire::lead::WindTick* PlayOut::next(MonoTime until) {
  const std::uint64_t first_kept = newest_ >= kKept ? newest_ - kKept + 1 : 1;
  for (std::uint64_t number = std::max(played_ + 1, first_kept); number <= newest_; ++number) {
    const wire::lead::WindTick* const tick = at(number);
    if (tick == nullptr) continue;
    if (number - tick->periods > played_ && due(number) > until) return nullptr;
    played_ = number;
    return tick;
  }
  return nullptr;
}

bool PlayOut::go_back_to(std::uint64_t number) {
  if (number >= played_) return number == played_;
  for (std::uint64_t later = played_; later > number;) {
    const wire::lead::WindTick* const tick = at(later);
    if (tick == nullptr) return false;
    later -= std::min<std::uint64_t>(later, tick->periods);
    if (later < number) return false;
  }
  played_ = number;
  return true;
}

std::array<PlayOut::Gap, PlayOut::kMaxGaps> PlayOut::gaps(MonoTime now) const noexcept {
  std::array<Gap, kMaxGaps> gaps{};
  std::size_t count = 0;
  std::uint64_t before = played_;
  const std::uint64_t first_kept = newest_ >= kKept ? newest_ - kKept + 1 : 1;
  for (std::uint64_t number = std::max(before + 1, first_kept); number <= newest_ && count < kMaxGaps; ++number) {
    const wire::lead::WindTick* const tick = at(number);
    if (tick == nullptr) continue;
    if (number - tick->periods > before && due(number - tick->periods) > now)
      gaps[count++] = {.from = before + 1, .to = number - tick->periods};
    before = number;
  }
  return gaps;
}

}  // namespace yuragi::daemon::follow
