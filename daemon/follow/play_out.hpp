#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/time.hpp"
#include "engine/wire/lead/wind_tick.hpp"

namespace yuragi::daemon::follow {

/// The ticks of a leader as they arrive: late, twice, in another order, with gaps; and as they are played: in their
/// order, each at its time. The time of a tick follows from its number and from the quickest arrivals of late, not from
/// a clock of another machine, and is `delay` after the tick would have arrived as quickly as these.
///
/// Pure: time is a parameter. Keeps the last kKept ticks. Thread-safe: no. Allocates only in its constructor.
class PlayOut {
 public:
  static constexpr std::size_t kKept = 1024;

  PlayOut(double rate_hz, Nanoseconds delay);

  /// Forgets everything; from now on only ticks of this epoch are taken.
  void begin(std::uint64_t epoch);
  std::uint64_t epoch() const noexcept { return epoch_; }

  enum class Taken : std::uint8_t {
    kNew,
    kKnown,    ///< it was taken before, or its time is long over
    kNotOfIt,  ///< of another epoch, or so far ahead that it cannot be the next of these
  };
  Taken take(const wire::lead::WindTick& tick, MonoTime arrival);

  /// The next tick in order, at whatever time it is due; null if it is missing. A missing one is passed over when the
  /// one after it is due until then. Valid until the next call.
  const wire::lead::WindTick* next(MonoTime until);
  MonoTime due(std::uint64_t number) const noexcept;

  /// next() goes on after this number again, if all ticks since are known. Returns false, and changes nothing, if not.
  bool go_back_to(std::uint64_t number);

  struct Gap {
    std::uint64_t from = 0, to = 0;  ///< the numbers of the first and the last period in it
  };
  static constexpr std::size_t kMaxGaps = 8;
  /// The first gaps in what next() has not returned yet and whose time has not come; the others are empty, and `to` is
  /// 0.
  std::array<Gap, kMaxGaps> gaps(MonoTime now) const noexcept;

  /// The number of the newest tick; 0: none.
  std::uint64_t newest() const noexcept { return newest_; }
  /// Of the last one that next() returned.
  std::uint64_t played() const noexcept { return played_; }
  const wire::lead::WindTick* last() const noexcept { return at(played_); }

 private:
  const wire::lead::WindTick* at(std::uint64_t number) const noexcept;
  void learn(std::uint64_t number, MonoTime arrival) noexcept;

  const double rate_hz_;
  const Nanoseconds delay_;
  std::vector<wire::lead::WindTick> ticks_;  ///< by number, modulo kKept; the number 0: none
  std::uint64_t epoch_ = 0;
  std::uint64_t first_ = 0;   ///< the number from which times count
  std::uint64_t played_ = 0;  ///< the number of the last one that next() returned
  std::uint64_t newest_ = 0;

  // The quickest arrival: the moment at which the tick first_ would have come. Of the present window, and of the last.
  MonoTime window_begin_{};
  std::optional<MonoTime> quickest_, quickest_before_;
};

}  // namespace yuragi::daemon::follow
