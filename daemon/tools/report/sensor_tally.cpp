#include "daemon/tools/report/sensor_tally.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace yuragi::daemon::tools::report {
namespace {

/// The number of points in the scatter plot of directions.
constexpr double kDirectionPoints = 1500.0;
constexpr double kDay_s = 86400.0;

/// A segment is at most a quarter of the longest run, so that several are averaged, and at most about an hour: slower
/// changes are weather.
constexpr std::uint64_t kMinSegment = 64;
constexpr std::uint64_t kMaxSegment = 1 << 15;
constexpr double kMaxSegment_s = 4100.0;
/// The autocorrelation is that of half an hour, if runs are long enough.
constexpr double kCorrelationBlock_s = 1800.0;
constexpr double kMaxCorrelationSamples = 1 << 17;
/// With a smaller part of readings with a direction only the speed is analysed.
constexpr double kMostlyDirected = 0.9;

RecordedState state_of(wind::judging::ReadingFault fault) {
  switch (fault) {
    case wind::judging::ReadingFault::kNone:
      return RecordedState::kLive;
    case wind::judging::ReadingFault::kSpike:
      return RecordedState::kSpike;
    case wind::judging::ReadingFault::kImplausible:
      return RecordedState::kImplausible;
    case wind::judging::ReadingFault::kFrozen:
      return RecordedState::kFrozen;
    case wind::judging::ReadingFault::kSeized:
      return RecordedState::kSeized;
  }
  return RecordedState::kLive;
}

wind::turbulence::Prior prior_of(const Settings& settings, const std::string& sensor) {
  return settings.prior ? settings.prior(sensor) : wind::turbulence::Prior{};
}

}  // namespace

SensorTally::SensorTally(const SensorSurvey& survey, double begin_s, double end_s, const Settings& settings)
    : settings_(settings),
      begin_s_(begin_s),
      end_s_(end_s),
      has_gusts_(survey.gusts > 0),
      unchanged_for_s_(survey.unchanged_for_s),
      record_(survey.unchanged_for_s),
      judge_(settings.judge),
      lesson_(prior_of(settings, survey.name), survey.interval_s),
      three_seconds_(survey.interval_s),
      blocks_(survey.interval_s),
      next_direction_s_(begin_s) {
  numbers_.name = survey.name;
  numbers_.driver = survey.driver;
  numbers_.unchanged_for_s = survey.unchanged_for_s;
  numbers_.interval_s = survey.interval_s;
  numbers_.assumed_length_m = prior_of(settings, survey.name).length_m;
  numbers_.bins.resize(kTimeBins);
  plan_spectrum(survey);
}

void SensorTally::plan_spectrum(const SensorSurvey& survey) {
  if (!(survey.step_s > 0.0)) {
    numbers_.why_no_spectrum = "No two readings are close enough to each other.";
    return;
  }
  const auto longest = std::min<std::uint64_t>(
      {survey.longest_run / 4, kMaxSegment, static_cast<std::uint64_t>(kMaxSegment_s / survey.step_s)});
  series_.emplace(survey.step_s);
  if (longest >= kMinSegment) {
    const bool is_of_speed =
        static_cast<double>(survey.directed) < kMostlyDirected * static_cast<double>(survey.readings);
    spectrum_.emplace(std::bit_floor(longest), survey.step_s, is_of_speed);
  } else {
    numbers_.why_no_spectrum = fmt::format(
        "A spectrum needs {} readings in a row that are at most a minute apart; the longest run has {}, {:.3g} s "
        "apart.",
        4 * kMinSegment, survey.longest_run, survey.step_s);
  }
  const double block = std::min(
      {static_cast<double>(survey.longest_run), kCorrelationBlock_s / survey.step_s + 0.5, kMaxCorrelationSamples});
  if (block >= static_cast<double>(kMinSegment)) {
    integral_time_.emplace(static_cast<std::size_t>(block), survey.step_s);
  }
}

std::size_t SensorTally::bin_of(double time_s) const {
  const double part = end_s_ > begin_s_ ? (time_s - begin_s_) / (end_s_ - begin_s_) : 0.0;
  return std::min(static_cast<std::size_t>(part * kTimeBins), kTimeBins - 1);
}

std::size_t SensorTally::hour_of(UtcTime moment) {
  // Time zones change their offset only on a quarter of an hour.
  const auto quarter =
      std::chrono::floor<std::chrono::duration<std::int64_t, std::ratio<900>>>(moment.time_since_epoch());
  if (known_quarter_ != quarter.count()) {
    const UtcTime local = moment + (settings_.utc_offset ? settings_.utc_offset(moment) : Nanoseconds{0});
    const auto since_midnight = local - std::chrono::floor<std::chrono::days>(local);
    known_hour_ = static_cast<std::size_t>(std::chrono::floor<std::chrono::hours>(since_midnight).count());
    known_quarter_ = quarter.count();
  }
  return known_hour_;
}

void SensorTally::mark(RecordedState state, double from_s, double to_s) {
  states_.add(state, from_s, to_s);
  if (state == RecordedState::kLive || !(to_s > from_s)) return;
  if (state != RecordedState::kSpike) was_interrupted_ = true;
  for (std::size_t bin = bin_of(from_s); bin <= bin_of(to_s); ++bin) {
    numbers_.bins[bin].gravest = std::max(numbers_.bins[bin].gravest, state);
  }
}

void SensorTally::add(Nanoseconds log_time, const wind::Reading& reading) {
  const double time_s = seconds(log_time);
  wind::Reading played = reading;
  played.time.mono = MonoTime(log_time);

  // The state since the last reading. After a single reading the record has no interval yet.
  const double patience_s = std::max({1.0, settings_.stale_intervals * numbers_.interval_s, unchanged_for_s_});
  if (!record_.has_reading()) {
    if (time_s - begin_s_ > patience_s) mark(RecordedState::kStale, begin_s_, time_s);
    numbers_.first_s = time_s;
    numbers_.first = reading.time.utc;
  } else {
    const bool was_silent = numbers_.readings == 1 ? time_s - numbers_.last_s > patience_s
                                                   : !record_.is_live(played.time.mono, settings_.stale_intervals);
    mark(was_silent ? RecordedState::kStale : state_, numbers_.last_s, time_s);
  }
  numbers_.last_s = time_s;
  numbers_.last = reading.time.utc;
  record_.take(played);
  ++numbers_.readings;
  ++numbers_.quality.at(static_cast<std::size_t>(reading.quality));

  // As in the daemon, simulated readings are not judged: they may be constant.
  const bool is_judged = reading.quality != wind::ReadingQuality::kSimulated;
  const bool is_believed = !is_judged || judge_.judge(played);
  state_ = is_judged ? state_of(judge_.fault()) : RecordedState::kLive;
  if (is_believed) add_believed(log_time, played);
}

void SensorTally::add_believed(Nanoseconds log_time, const wind::Reading& reading) {
  const double time_s = seconds(log_time);
  const double speed_m_s = reading.speed_m_s;
  if (numbers_.believed++ == 0) numbers_.min_m_s = numbers_.max_m_s = speed_m_s;
  numbers_.min_m_s = std::min(numbers_.min_m_s, speed_m_s);
  if (speed_m_s >= numbers_.max_m_s) {
    numbers_.max_m_s = speed_m_s;
    numbers_.max_at_s = time_s;
  }
  speeds_.add(speed_m_s, hour_of(reading.time.utc));

  // Gusts.
  const std::optional<double> mean_m_s = three_seconds_.add(log_time, speed_m_s);
  blocks_.add(time_s, speed_m_s, mean_m_s);
  const auto raise = [](std::optional<double>& highest, const std::optional<double>& value) {
    if (value) highest = std::max(highest.value_or(*value), *value);
  };
  raise(numbers_.gust_3s_m_s, mean_m_s);
  raise(numbers_.reported_gust_m_s, reading.gust_m_s);

  // Directions, as vectors.
  if (reading.direction_deg) {
    ++numbers_.directed;
    held_direction_deg_ = reading.direction_deg;
    rose_.add(speed_m_s, *reading.direction_deg);
    wind_sum_ = wind_sum_ + wind::wind_from(speed_m_s, *reading.direction_deg);
    directed_speed_sum_m_s_ += speed_m_s;
    if (time_s >= next_direction_s_) {
      numbers_.directions.push_back({time_s, *reading.direction_deg});
      const double step_s = (end_s_ - begin_s_) / kDirectionPoints;
      if (step_s > 0.0) next_direction_s_ = begin_s_ + step_s * (std::floor((time_s - begin_s_) / step_s) + 1.0);
    }
  }
  lesson_.add(time_s, speed_m_s,
              held_direction_deg_ ? std::optional(wind::wind_from(speed_m_s, *held_direction_deg_)) : std::nullopt);
  add_to_bin(time_s, reading, has_gusts_ ? reading.gust_m_s : mean_m_s);

  if (!series_) return;
  EvenSample sample{.speed_m_s = speed_m_s, .wind = {}};
  if (held_direction_deg_) sample.wind = wind::wind_from(speed_m_s, *held_direction_deg_);
  series_->add(
      time_s, sample,
      [this](const EvenSample& even) {
        if (spectrum_) spectrum_->add(even);
        if (integral_time_) integral_time_->add(even.speed_m_s);
      },
      [this] {
        if (spectrum_) spectrum_->interrupt();
        if (integral_time_) integral_time_->interrupt();
      });
}

void SensorTally::add_to_bin(double time_s, const wind::Reading& reading, const std::optional<double>& gust_m_s) {
  TimeBin& bin = numbers_.bins[bin_of(time_s)];
  if (bin.count++ == 0) {
    bin.min_m_s = bin.max_m_s = reading.speed_m_s;
    bin.follows_silence = was_interrupted_;
  }
  was_interrupted_ = false;
  bin.time_sum_s += time_s;
  bin.speed_sum_m_s += reading.speed_m_s;
  bin.min_m_s = std::min(bin.min_m_s, reading.speed_m_s);
  bin.max_m_s = std::max(bin.max_m_s, reading.speed_m_s);
  if (gust_m_s) bin.gust_m_s = std::max(bin.gust_m_s.value_or(0.0), *gust_m_s);
  if (!reading.direction_deg) return;
  const wind::Vector wind = wind::wind_from(reading.speed_m_s, *reading.direction_deg);
  ++bin.directed;
  bin.u_sum_m_s += wind.u_m_s;
  bin.v_sum_m_s += wind.v_m_s;
}

SensorNumbers SensorTally::finish() {
  // From its last reading to the end of the recording it may have been silent.
  const MonoTime end(from_seconds(end_s_));
  if (record_.has_reading() && end_s_ > numbers_.last_s) {
    const bool is_live = record_.is_live(end, settings_.stale_intervals);
    mark(is_live ? state_ : RecordedState::kStale, numbers_.last_s, end_s_);
  }
  numbers_.states = states_.totals();
  numbers_.events = states_.events();
  numbers_.spikes = judge_.spikes();

  numbers_.mean_m_s = speeds_.mean_m_s();
  numbers_.deviation_m_s = speeds_.deviation_m_s();
  numbers_.distribution = speeds_.distribution();
  if (numbers_.last_s - numbers_.first_s > kDay_s) numbers_.diurnal = speeds_.hours();
  numbers_.rose = rose_.finish();
  numbers_.blocks = blocks_.finish();
  if (directed_speed_sum_m_s_ > 0.0) {
    numbers_.direction_deg = wind::direction_from_deg(wind_sum_);
    numbers_.steadiness = speed_of(wind_sum_) / directed_speed_sum_m_s_;
  }
  if (spectrum_) {
    numbers_.spectrum = spectrum_->numbers();
    if (!numbers_.spectrum) numbers_.why_no_spectrum = "The sensor was never live for long enough.";
  }
  if (integral_time_) numbers_.integral_time_s = integral_time_->seconds();
  numbers_.site = lesson_.numbers();
  return std::move(numbers_);
}

}  // namespace yuragi::daemon::tools::report
