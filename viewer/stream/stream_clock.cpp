#include "viewer/stream/stream_clock.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::viewer::stream {
namespace {

constexpr double kClockDrift = 0.001;       // two machines' clocks drift apart by less than this, s/s
constexpr double kWaitMemory_s = 10.0;      // the time constant with which a long wait is forgotten
constexpr double kMargin = 0.5;             // of a frame interval
constexpr double kIntervalSmoothing = 0.1;  // share of a new interval in the average
constexpr double kMinInterval_s = 0.001;
constexpr double kMaxInterval_s = 0.25;

}  // namespace

void Clock::observe(double sender_s, double local_s) {
  const double offset_s = local_s - sender_s;
  if (!has_observed_) {
    has_observed_ = true;
    offset_s_ = offset_s;
  } else {
    const double passed_s = std::max(0.0, local_s - last_local_s_);
    const double interval_s = std::clamp(sender_s - last_sender_s_, kMinInterval_s, kMaxInterval_s);
    interval_s_ += kIntervalSmoothing * (interval_s - interval_s_);
    offset_s_ = std::min(offset_s, offset_s_ + kClockDrift * passed_s);
    const double wait_s = offset_s - offset_s_ + std::max(0.0, sender_s - last_sender_s_);
    wait_s_ = std::max(wait_s, wait_s_ + (wait_s - wait_s_) * -std::expm1(-passed_s / kWaitMemory_s));
  }
  last_sender_s_ = sender_s;
  last_local_s_ = local_s;
}

double Clock::delay_s() const {
  return std::min(std::max(wait_s_, interval_s_) + kMargin * interval_s_, kMaxDelay_s);
}

}  // namespace yuragi::viewer::stream
