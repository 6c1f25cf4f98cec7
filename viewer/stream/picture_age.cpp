#include "viewer/stream/picture_age.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace yuragi::viewer::stream {
namespace {

constexpr double kClockDrift = 0.001;      // two machines' clocks drift apart by less than this, s/s
constexpr double kMaxWay_s = 10.0;         // a frame that took longer was stamped by another clock than ours,
constexpr double kEarliestWay_s = -0.001;  // and so was one that arrived before it was made
constexpr double kNewRun_s = 1.0;          // the sender's time advanced by this much more than ours

}  // namespace

void PictureAge::take_frame(const wire::FrameInfo& frame, double arrival_s, double arrival_utc_s,
                            bool is_same_machine) {
  const double passed_s = arrival_s - last_arrival_s_;
  const bool is_new_run =
      !has_begun_ || frame.time_s < last_sender_s_ || frame.time_s > last_sender_s_ + passed_s + kNewRun_s;
  const double way_s = arrival_utc_s - 1e-9 * static_cast<double>(frame.utc_ns);
  const bool is_known = is_same_machine && way_s >= kEarliestWay_s && way_s <= kMaxWay_s;
  if (is_new_run || is_known != is_network_known_) count_ = 0;
  const double arrival_zero_s = arrival_s - frame.time_s;
  if (is_known) {
    sender_zero_s_ = arrival_zero_s - std::max(0.0, way_s);
  } else if (is_new_run || is_network_known_) {
    sender_zero_s_ = arrival_zero_s;
  } else {
    sender_zero_s_ = std::min(arrival_zero_s, sender_zero_s_ + kClockDrift * std::max(0.0, passed_s));
  }
  has_begun_ = true;
  is_network_known_ = is_known;
  last_sender_s_ = frame.time_s;
  last_arrival_s_ = arrival_s;
}

void PictureAge::take_picture(const PoseMoment& moment, double shown_s, double display_s) {
  if (!has_begun_ || !(moment.wind.live_weight > 0.0)) return;
  const double since_tick_s = std::max(0.0, shown_s - (sender_zero_s_ + moment.time_s));
  display_s_ = display_s;
  shown_.at(next_) = {shown_s, moment.wind.reading_age_s + since_tick_s + display_s};
  next_ = (next_ + 1) % kMaxPictures;
  count_ = std::min(count_ + 1, kMaxPictures);
}

std::optional<AgeFigures> PictureAge::figures(double now_s) const {
  std::array<double, kMaxPictures> ages_s{};
  std::size_t pictures = 0;
  for (; pictures < count_; ++pictures) {
    const Shown& shown = shown_.at((next_ + kMaxPictures - 1 - pictures) % kMaxPictures);
    if (now_s - shown.at_s > kSpan_s) break;
    ages_s.at(pictures) = shown.age_s;
  }
  if (pictures == 0) return std::nullopt;
  AgeFigures age{
      .newest_s = ages_s.front(), .display_s = display_s_, .pictures = pictures, .is_network_known = is_network_known_};
  const auto end = ages_s.begin() + static_cast<std::ptrdiff_t>(pictures);
  std::sort(ages_s.begin(), end);
  const auto share_of = [&](double share) {
    return ages_s.at(static_cast<std::size_t>(std::lround(share * static_cast<double>(pictures - 1))));
  };
  age.p50_s = share_of(0.5);
  age.p95_s = share_of(0.95);
  age.max_s = share_of(1.0);
  return age;
}

std::string age_text(const AgeFigures& age) {
  std::string text =
      fmt::format("reading {:.0f} ms old when it was shown (of 10 s: p50 {:.0f}, p95 {:.0f}, at most {:.0f} ms",
                  1e3 * age.newest_s, 1e3 * age.p50_s, 1e3 * age.p95_s, 1e3 * age.max_s);
  if (age.display_s > 0.0) text += fmt::format("; {:.0f} ms of it for the display, an estimate", 1e3 * age.display_s);
  if (!age.is_network_known)
    text += "; without the way through the network, as the daemon's clock is another machine's";
  return text + ")";
}

}  // namespace yuragi::viewer::stream
