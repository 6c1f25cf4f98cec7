#include "daemon/tools/offline/offline_wind.hpp"

#include <algorithm>
#include <vector>

namespace yuragi::daemon::tools::offline {
namespace {

/// The readings for the estimator: each at its log time, without those in the gaps, and averaged if a slower sensor
/// is simulated.
class PlayedReadings {
 public:
  PlayedReadings(drivers::windlog::Playback& playback, const WindOptions& options)
      : playback_(playback), options_(options) {}

  /// Nullopt at the end, or if the recording cannot be read.
  std::optional<wind::Reading> next() { return options_.sensor_interval_s ? next_mean() : next_single(); }

  /// Why it cannot be read; nullopt if it can.
  const std::optional<Failure>& failure() const { return failure_; }

 private:
  std::optional<wind::Reading> next_single() {
    for (;;) {
      const auto played = playback_.next();
      if (!played) failure_ = played.error();
      if (!played || !*played) return std::nullopt;
      const double log_time_s = (*played)->log_time_s;
      if (is_in_gap(log_time_s)) continue;
      wind::Reading reading = (*played)->reading;
      reading.time.mono = MonoTime(from_seconds(log_time_s));
      return reading;
    }
  }

  /// The mean over one block of time; blocks without readings are skipped.
  std::optional<wind::Reading> next_mean() {
    if (!held_) held_ = next_single();
    if (!held_) return std::nullopt;
    // In whole nanoseconds, which may be off by one after conversion from seconds: a reading on the edge of two blocks
    // belongs to the later one, and the mean is available at the end of its block.
    const Nanoseconds interval = from_seconds(*options_.sensor_interval_s);
    const Nanoseconds edge = ((held_->time.mono.time_since_epoch() + Nanoseconds(1)) / interval + 1) * interval;
    const MonoTime end(from_seconds(seconds(edge)));

    wind::Vector sum{};
    double speed_sum_m_s = 0.0;
    double gust_m_s = 0.0;
    std::size_t count = 0;
    std::size_t directed = 0;
    for (; held_ && held_->time.mono < end; held_ = next_single(), ++count) {
      speed_sum_m_s += held_->speed_m_s;
      gust_m_s = std::max(gust_m_s, held_->gust_m_s.value_or(held_->speed_m_s));
      if (!held_->direction_deg) continue;
      sum = sum + wind::wind_from(held_->speed_m_s, *held_->direction_deg);
      ++directed;
    }
    const bool has_direction = directed == count;
    const wind::Vector mean = (1.0 / static_cast<double>(count)) * sum;
    wind::Reading reading;
    reading.time.mono = end;
    reading.speed_m_s = has_direction ? speed_of(mean) : speed_sum_m_s / static_cast<double>(count);
    if (has_direction) reading.direction_deg = wind::direction_from_deg(mean);
    reading.gust_m_s = gust_m_s;
    return reading;
  }

  bool is_in_gap(double time_s) const {
    return std::ranges::any_of(options_.gaps,
                               [time_s](const Gap& gap) { return time_s >= gap.from_s && time_s < gap.to_s; });
  }

  drivers::windlog::Playback& playback_;
  const WindOptions& options_;
  std::optional<wind::Reading> held_;
  std::optional<Failure> failure_;
};

/// One source of the estimator.
class Source {
 public:
  Source(drivers::windlog::Playback& playback, const WindOptions& options)
      : readings_(playback, options), next_(readings_.next()) {}

  bool has_more() const { return next_.has_value(); }
  const std::optional<Failure>& failure() const { return readings_.failure(); }

  /// Passes the readings up to `now` that `jury` believes to the estimator, as source `number`.
  void feed(wind::blend::BlendedEstimator& estimator, sensing::SensorJury& jury, std::size_t number, MonoTime now,
            WindResult& result) {
    for (; next_ && next_->time.mono <= now; next_ = readings_.next()) {
      if (jury.hear(number, *next_) != sensing::SensorJury::Verdict::kBelieved) {
        ++result.withheld;
      } else if (estimator.accept(number, jury.levelled(number, *next_))) {
        ++result.readings;
      }
    }
  }

 private:
  PlayedReadings readings_;
  std::optional<wind::Reading> next_;
};

}  // namespace

Result<WindResult, Failure> run_offline(std::span<drivers::windlog::Playback> playbacks,
                                        wind::blend::BlendedEstimator& estimator, const WindOptions& options,
                                        const std::function<void(double time_s, const wind::State&)>& use) {
  WindResult result;
  std::vector<Source> sources;
  for (drivers::windlog::Playback& playback : playbacks) sources.emplace_back(playback, options);
  sensing::SensorJury jury(std::vector(sources.size(), options.rules), options.stale_intervals,
                           options.has_relative_gains);
  const auto has_more = [&] { return std::ranges::any_of(sources, &Source::has_more); };
  // The last tick is the first at or after the last reading.
  for (bool goes_on = has_more(); goes_on; ++result.states) {
    const double time_s = static_cast<double>(result.states) / options.rate_hz;
    const MonoTime now(from_seconds(time_s));
    for (std::size_t i = 0; i < sources.size(); ++i) sources[i].feed(estimator, jury, i, now, result);
    jury.compare(now);
    for (const Source& source : sources) {
      if (source.failure()) return *source.failure();
    }
    goes_on = has_more() && time_s + 1.0 / options.rate_hz <= options.until_s;
    use(time_s, estimator.advance(now));
    result.duration_s = time_s;
  }
  return result;
}

}  // namespace yuragi::daemon::tools::offline
