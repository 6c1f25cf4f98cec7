#include "drivers/json/observation_watch.hpp"

#include <charconv>
#include <string_view>

#include "drivers/windlog/iso_time.hpp"

namespace yuragi::drivers::json {
namespace {

/// Of a moment that nanoseconds can count, in the year 2255. Above this a number is one of milliseconds.
constexpr double kMaxSeconds = 9e9;

/// "Z", "+02", "+0200" or "+02:00" behind the clock.
bool has_zone(std::string_view time) {
  if (time.ends_with('Z') || time.ends_with('z')) return true;
  const std::size_t clock = time.find(':');
  return clock != std::string_view::npos && time.find_first_of("+-", clock) != std::string_view::npos;
}

}  // namespace

std::optional<UtcTime> moment_of(const std::string& time) {
  double number = 0.0;
  const char* const end = time.data() + time.size();
  if (const auto read = std::from_chars(time.data(), end, number); read.ec == std::errc{} && read.ptr == end) {
    const double moment_s = number > kMaxSeconds ? number / 1000.0 : number;
    if (!(moment_s > 0.0) || moment_s > kMaxSeconds) return std::nullopt;
    return UtcTime(from_seconds(moment_s));
  }
  return has_zone(time) ? windlog::parse_iso_time(time) : std::nullopt;
}

Novelty ObservationWatch::take(const decode::network::JsonWind& observation, const Instant& now) {
  const bool has_time = !observation.time.empty();
  const bool is_same = last_ && last_->time == observation.time && (has_time || last_->wind == observation.wind);
  if (is_same) return take_unchanged(now);
  last_ = observation;
  moment_ = has_time ? moment_of(observation.time) : std::nullopt;
  new_at_ = now.mono;
  return is_of_the_past(now) ? Novelty::kOld : Novelty::kNew;
}

Novelty ObservationWatch::take_unchanged(const Instant& now) {
  const Nanoseconds unchanged_for = now.mono - new_at_;
  if (!last_->time.empty()) return unchanged_for > silence_ || is_of_the_past(now) ? Novelty::kOld : Novelty::kRepeated;
  if (unchanged_for < interval_) return Novelty::kRepeated;
  new_at_ = now.mono;
  return Novelty::kNew;
}

bool ObservationWatch::is_of_the_past(const Instant& now) const {
  return moment_ && now.utc - *moment_ > silence_;
}

}  // namespace yuragi::drivers::json
