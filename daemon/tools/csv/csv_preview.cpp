#include "daemon/tools/csv/csv_preview.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_text.hpp"
#include "engine/base/compass.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

constexpr Nanoseconds kLeastInterval = std::chrono::milliseconds(10);
constexpr double kGreatestMean_m_s = 40.0;
constexpr double kGreatChange_m_s = 10.0;
constexpr double kShareOfGreatChanges = 0.3;
/// A step of so many usual ones is a gap.
constexpr std::int64_t kGap = 3;

/// To two digits: 1.04 s is 1 s.
std::int64_t rounded(std::int64_t ns) {
  std::int64_t unit = 1;
  while (ns / unit >= 100) unit *= 10;
  return (ns + unit / 2) / unit * unit;
}

/// "0.1 s", "10 min", "3.5 h"
std::string duration_text(Nanoseconds duration) {
  const double s = seconds(duration);
  constexpr double kMinute_s = 60.0;
  constexpr double kHour_s = 3600.0;
  constexpr double kDay_s = 86400.0;
  if (s < 2.0 * kMinute_s) return fmt::format("{:.3g} s", s);
  if (s < 2.0 * kHour_s) return fmt::format("{:.3g} min", s / kMinute_s);
  if (s < 2.0 * kDay_s) return fmt::format("{:.3g} h", s / kHour_s);
  return fmt::format("{:.4g} days", s / kDay_s);
}

std::string time_text(UtcTime time) {
  std::string text;
  append_utc(text, std::chrono::floor<std::chrono::milliseconds>(time));
  constexpr std::size_t kToMilliseconds = 23;
  return text.substr(0, kToMilliseconds) + "Z";
}

}  // namespace

void Preview::take(std::string_view sensor, const wind::Reading& reading) {
  if (!first_) first_ = reading.time;
  last_utc_ = reading.time.utc;
  ++count_;
  speed_sum_m_s_ += reading.speed_m_s;
  strongest_m_s_ = std::max(strongest_m_s_, reading.speed_m_s);
  if (reading.gust_m_s) {
    ++gusts_;
    strongest_gust_m_s_ = std::max(strongest_gust_m_s_, *reading.gust_m_s);
  }
  if (reading.direction_deg) {
    ++with_direction_;
    const auto point = static_cast<std::size_t>(std::lround(*reading.direction_deg / kDegPerCompassPoint));
    ++sectors_[point % sectors_.size()];
  }

  const auto known = last_.find(sensor);
  constexpr std::size_t kMaxSensors = 1000;
  if (known == last_.end()) {
    if (last_.size() < kMaxSensors) last_.emplace(sensor, Last{reading.time.mono, reading.speed_m_s});
    return;
  }
  Last& last = known->second;
  const Nanoseconds step = reading.time.mono - last.time;
  ++step_count_;
  step_sum_ += step;
  // Most steps are as long as the one before.
  if (step.count() != last_step_.first) last_step_ = {step.count(), &steps_[rounded(step.count())]};
  ++*last_step_.second;
  const double change_m_s = std::abs(reading.speed_m_s - last.speed_m_s);
  greatest_change_m_s_ = std::max(greatest_change_m_s_, change_m_s);
  if (change_m_s > kGreatChange_m_s) ++great_changes_;
  last = {reading.time.mono, reading.speed_m_s};
}

Nanoseconds Preview::usual_step() const {
  const auto most = std::ranges::max_element(steps_, {}, [](const auto& each) { return each.second; });
  return Nanoseconds(most == steps_.end() ? 0 : most->first);
}

double Preview::mean_m_s() const {
  return speed_sum_m_s_ / static_cast<double>(std::max<std::size_t>(1, count_));
}

std::vector<std::string> Preview::describe() const {
  if (!first_) return {};
  std::vector<std::string> lines;
  lines.push_back(fmt::format("from {} to {}", time_text(first_->utc), time_text(last_utc_)));
  if (step_count_ > 0) {
    const Nanoseconds usual = usual_step();
    std::size_t gaps = 0;
    std::int64_t longest_ns = 0;
    for (const auto& [step_ns, times] : steps_) {
      if (step_ns <= kGap * usual.count()) continue;
      gaps += times;
      longest_ns = std::max(longest_ns, step_ns);
    }
    const std::string gap_text =
        gaps == 0 ? "no gaps"
                  : fmt::format("{}, the longest {}", count_text(gaps, "gap"), duration_text(Nanoseconds(longest_ns)));
    lines.push_back(fmt::format("a reading every {}, {}", duration_text(usual), gap_text));
  }
  lines.push_back(fmt::format(
      "mean {:.2f} m/s, strongest {:.2f} m/s{}, largest change {:.2f} m/s", mean_m_s(), strongest_m_s_,
      gusts_ > 0 ? fmt::format(", strongest gust {:.2f} m/s", strongest_gust_m_s_) : "", greatest_change_m_s_));
  if (with_direction_ == 0) {
    lines.emplace_back("no directions");
  } else {
    std::string points;
    for (std::size_t i = 0; i < sectors_.size(); ++i) {
      if (sectors_[i] > 0) points += fmt::format("{}{}", points.empty() ? "" : " ", kCompassPoints[i]);
    }
    const auto most = std::ranges::max_element(sectors_) - sectors_.begin();
    lines.push_back(fmt::format("directions in {:.0f} % of the readings, most from {}: {}",
                                100.0 * static_cast<double>(with_direction_) / static_cast<double>(count_),
                                kCompassPoints[static_cast<std::size_t>(most)], points));
  }
  return lines;
}

std::vector<std::string> Preview::implausible() const {
  std::vector<std::string> lines;
  constexpr std::size_t kMinSteps = 10;
  if (step_count_ >= kMinSteps) {
    const Nanoseconds mean_step = step_sum_ / static_cast<std::int64_t>(step_count_);
    if (mean_step < kLeastInterval) {
      lines.push_back(fmt::format("a reading every {} on average, below {}: check --time, --date and --time-format",
                                  duration_text(mean_step), duration_text(kLeastInterval)));
    }
    const double share = static_cast<double>(great_changes_) / static_cast<double>(step_count_);
    if (share > kShareOfGreatChanges) {
      lines.push_back(
          fmt::format("in {:.0f} % of the steps the speed changes by more than {} m/s: check --speed and --unit",
                      100.0 * share, kGreatChange_m_s));
    }
  }
  if (mean_m_s() > kGreatestMean_m_s) {
    lines.push_back(
        fmt::format("the mean is {:.1f} m/s, above {} m/s: check --speed and --unit", mean_m_s(), kGreatestMean_m_s));
  }
  return lines;
}

}  // namespace yuragi::daemon::tools::csv
