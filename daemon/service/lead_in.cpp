#include "daemon/service/lead_in.hpp"

#include <cmath>
#include <cstdint>
#include <thread>

namespace yuragi::daemon::service {
namespace {

/// The number of ticks that are measured, and the factor on the time that all would take at their pace.
constexpr int kMeasuredTicks = 30;
constexpr double kPlanned = 1.25;

}  // namespace

void lead_in(double lead_s, double rate_hz, sensing::HeldClock& clock, sensing::SensorHub& hub,
             const std::function<wind::ground::DrivingWind()>& next_wind, animation::Animation& animation) {
  for (const sensing::NamedPlayer& named : hub.players()) named.player->begin_early(lead_s);
  const double period_s = 1.0 / rate_hz;
  const auto ticks = std::llround(lead_s * rate_hz);
  const Instant now = clock.now();
  for (int tick = 0; tick < kMeasuredTicks; ++tick) animation.step({}, period_s);
  const double tick_s = seconds(clock.now().mono - now.mono) / kMeasuredTicks;
  const Nanoseconds planned = from_seconds(kPlanned * tick_s * static_cast<double>(ticks));

  const Instant begin{.mono = now.mono + planned, .utc = now.utc + planned};
  for (std::int64_t tick = -ticks; tick < ticks; ++tick) {
    const Nanoseconds from_begin = from_seconds(static_cast<double>(tick) * period_s);
    const Instant moment{.mono = begin.mono + from_begin, .utc = begin.utc + from_begin};
    if (tick >= 0 && moment.mono >= clock.of_machine().mono) break;
    clock.hold(moment);
    animation.step(next_wind(), period_s);
  }
  clock.let_go();
  std::this_thread::sleep_for(begin.mono - clock.now().mono);
  hub.begin_threads();
}

}  // namespace yuragi::daemon::service
