#include "viewer/stream/stream_clock.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::viewer::stream {
namespace {

constexpr double kClockDrift = 0.001;       // two machines' clocks drift apart by less than this, s/s
constexpr double kJitterMemory_s = 3.0;     // the time constant with which a late frame is forgotten
constexpr double kIntervalSmoothing = 0.1;  // share of a new interval in the average
constexpr double kMinInterval_s = 0.001;
constexpr double kMaxInterval_s = 0.25;

}  // namespace

void StreamClock::observe(double sender_s, double local_s) {
  const double offset_s = local_s - sender_s;
  if (!has_observed_) {
    has_observed_ = true;
    offset_s_ = offset_s;
  } else {
    const double passed_s = std::max(0.0, local_s - last_local_s_);
    const double interval_s = std::clamp(sender_s - last_sender_s_, kMinInterval_s, kMaxInterval_s);
    interval_s_ += kIntervalSmoothing * (interval_s - interval_s_);
    offset_s_ = std::min(offset_s, offset_s_ + kClockDrift * passed_s);
    jitter_s_ = std::max(offset_s - offset_s_, jitter_s_ * std::exp(-passed_s / kJitterMemory_s));
  }
  last_sender_s_ = sender_s;
  last_local_s_ = local_s;
}

double StreamClock::delay_s() const {
  return std::min(1.5 * interval_s_ + jitter_s_, kMaxDelay_s);
}

}  // namespace yuragi::viewer::stream
