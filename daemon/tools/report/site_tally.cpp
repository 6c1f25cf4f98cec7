#include "daemon/tools/report/site_tally.hpp"

#include <algorithm>
#include <cmath>

#include "engine/wind/blend/source_estimator.hpp"

namespace yuragi::daemon::tools::report {
namespace {

constexpr double kGapOfIntervals = 3.0;
/// As in blend::SourceEstimator: memories of the mean speed by which differences are divided, and of the mean
/// direction.
constexpr double kSpeedMemory_s = 60.0;
constexpr double kDirectionMemory_s = 100.0;

}  // namespace

SiteTally::SiteTally(const wind::turbulence::Prior& prior, double interval_s)
    : interval_s_(interval_s),
      length_m_(prior.length_m),
      quick_(prior, wind::blend::Settings{}.fit_memory_s),
      site_fit_(prior, wind::blend::Settings{}.fit_memory_s) {}

void SiteTally::add(double time_s, double speed_m_s, const std::optional<wind::Vector>& wind) {
  if (!(interval_s_ > 0.0) || interval_s_ > wind::turbulence::SiteSpectrum::kQuick_s) return;
  if (last_s_ && time_s - *last_s_ > kGapOfIntervals * interval_s_) {
    quick_.break_off();
    site_fit_.break_off();
  }
  last_s_ = time_s;
  measured_s_ += interval_s_;
  // A wind without a direction has the speed alone.
  const wind::Vector measured = wind.value_or(wind::Vector{0.0, speed_m_s});
  const auto part = [this](double memory_s) { return -std::expm1(-interval_s_ / std::min(memory_s, measured_s_)); };
  const bool is_first = measured_s_ == interval_s_;
  mean_ = mean_ + (is_first ? 1.0 : part(kDirectionMemory_s)) * (measured - mean_);
  speed_m_s_ += (is_first ? 1.0 : part(kSpeedMemory_s)) * (speed_m_s - speed_m_s_);

  const double mean_m_s = speed_of(mean_);
  const wind::Vector ahead = mean_m_s > 0.0 ? (1.0 / mean_m_s) * mean_ : wind::Vector{0.0, 1.0};
  const double divisor_m_s = std::max(speed_m_s_, wind::blend::kMinSpeed_m_s);
  quick_.forget(interval_s_);
  quick_.take(measured, ahead, divisor_m_s, wind.has_value());
  site_fit_.observe({.wind = measured,
                     .ahead = ahead,
                     .speed_m_s = divisor_m_s,
                     .interval_s = interval_s_,
                     .has_across = wind.has_value()},
                    quick_, site_);
}

std::optional<SiteNumbers> SiteTally::numbers() const {
  SiteNumbers numbers{.length_m = length_m_, .known_s = 0.0, .octaves_db = {}};
  const wind::turbulence::SiteSpectrum::Decibels octaves_db = site_.octaves_db();
  for (std::size_t octave = 0; octave < wind::turbulence::SiteSpectrum::kOctaves && site_.known_s()[octave] > 0.0;
       ++octave) {
    numbers.octaves_db.push_back(octaves_db[octave]);
    numbers.known_s = std::max(numbers.known_s, site_.known_s()[octave]);
  }
  if (numbers.octaves_db.empty()) return std::nullopt;
  return numbers;
}

}  // namespace yuragi::daemon::tools::report
