#include "viewer/stream/fixed_delay.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace yuragi::viewer::stream {
namespace {

constexpr double kZeroDrift = 0.001;  // the sender's UTC and its time line drift apart by less than this, s/s

}  // namespace

void FixedDelay::take_frame(const wire::FrameInfo& frame, double local_s) {
  if (!std::isfinite(frame.time_s)) return;
  const double zero_utc_s = 1e-9 * static_cast<double>(frame.utc_ns) - frame.time_s;
  const bool is_other_line = !has_begun_ || std::abs(zero_utc_s - zero_utc_s_) > kStep_s;
  if (is_other_line) {
    has_begun_ = true;
    zero_utc_s_ = zero_utc_s;
    arrivals_ = {};
    frames_ = 0;
  } else {
    // The frame before was the newest for as long as this one took: did a picture need this one?
    if (figures_.is_kept && utc_at_zero_s_) {
      const double target_s = local_s + *utc_at_zero_s_ - figures_.delay_s - zero_utc_s_;
      ++figures_.frames;
      if (target_s > last_sender_s_) ++figures_.late_frames;
    }
    const double passed_s = std::max(0.0, frame.time_s - last_sender_s_);
    zero_utc_s_ = std::min(zero_utc_s, zero_utc_s_ + kZeroDrift * passed_s);
  }
  last_sender_s_ = frame.time_s;
  frames_ = std::min(frames_ + 1, kSettling_frames);
  arrivals_.observe(frame.time_s, local_s);
}

std::optional<double> FixedDelay::target_s(double local_s, double utc_s) {
  if (!has_begun_) return std::nullopt;
  utc_at_zero_s_ = utc_s - local_s;
  const double target_s = utc_s - figures_.delay_s - zero_utc_s_;
  way_s_ = utc_s - zero_utc_s_ - arrivals_.quickest_s(local_s);
  const bool do_clocks_agree = way_s_ >= -kMaxEarliness_s && way_s_ < figures_.delay_s;
  if (!do_clocks_agree) {
    figures_.is_kept = false;
    if (frames_ < kSettling_frames) return std::nullopt;  // the quickest may be on its way
    if (!is_in_doubt_) ++figures_.losses;
    is_in_doubt_ = true;
    agreed_since_s_.reset();
    return std::nullopt;
  }
  if (!agreed_since_s_) agreed_since_s_ = local_s;
  if (is_in_doubt_ && local_s - *agreed_since_s_ < kReturn_s) return std::nullopt;
  is_in_doubt_ = false;
  figures_.is_kept = true;
  return target_s;
}

std::string FixedDelay::doubt_text() const {
  const double delay_ms = 1e3 * figures_.delay_s;
  const std::string what = way_s_ < 0.0
                               ? fmt::format("frames arrive {:.1f} s before the time at which they were made", -way_s_)
                               : fmt::format("the quickest frame arrives {:.0f} ms after it was made", 1e3 * way_s_);
  return fmt::format(
      "the delay of {:.0f} ms is not kept, and this screen is out of step: {}. Set the clocks of this machine and of "
      "the daemon's by one time server (`yuragi doctor` shows their offset), or give [[output]] a longer delay",
      delay_ms, what);
}

std::string delay_text(const DelayFigures& figures) {
  return fmt::format("delay {:.0f} ms {}; {} of {} frames late; given up {} times", 1e3 * figures.delay_s,
                     figures.is_kept ? "kept" : "not kept", figures.late_frames, figures.frames, figures.losses);
}

}  // namespace yuragi::viewer::stream
