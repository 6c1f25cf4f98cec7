#include "drivers/text/line_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace yuragi::drivers::text {
namespace {

constexpr std::string_view kSpeedKeys = "speed_key or speed_column";

/// How many separators a line has. Two lines that ran into each other have more, and one that was cut has fewer.
std::size_t shape_of(std::string_view line, char separator) {
  if (line.starts_with('{')) return 0;  // an object that is whole is JSON, and one that is not is none
  const bool has_keys = line.find_first_of("=:") != std::string_view::npos;
  if (has_keys)
    return static_cast<std::size_t>(std::ranges::count_if(line, [](char c) { return c == '=' || c == ':'; }));
  if (separator != ' ') return static_cast<std::size_t>(std::ranges::count(line, separator));

  // Any number of blanks separates once.
  std::size_t words = 0;
  bool is_in_token = false;
  for (const char c : line) {
    const bool is_blank = c == ' ' || c == '\t';
    if (!is_blank && !is_in_token) ++words;
    is_in_token = !is_blank;
  }
  return words;
}

}  // namespace

LineSensor::LineSensor(LineSensorSettings settings, std::unique_ptr<bus::BytePort> port)
    : Sensor(settings.text, std::move(port)), settings_(std::move(settings)), held_(settings_.hold) {}

void LineSensor::begin() {
  held_.clear();
  last_shapes_ = {};
  without_speed_.clear();
  follows_garbage_ = false;
}

/// The shape of the lines is the one that comes again: in the next line, or, where one value a line comes in turn, up
/// to three lines later. Other lines are refused.
bool LineSensor::has_known_shape(std::string_view line) {
  const std::size_t shape = shape_of(decode::trimmed(line), settings_.line.separator);
  const bool has_keys = line.find_first_of("=:") != std::string_view::npos;
  const auto end = has_keys ? last_shapes_.end() : last_shapes_.begin() + 1;
  const bool comes_again = std::find(last_shapes_.begin(), end, shape) != end;
  std::shift_right(last_shapes_.begin(), last_shapes_.end(), 1);
  last_shapes_.front() = shape;
  if (!shape_ || comes_again) shape_ = shape;
  return shape == *shape_;
}

void LineSensor::hold(const decode::text::LineWind& line, MonoTime now) {
  if (line.direction_refusal) {
    held_.lose_direction(now);
  } else if (line.names_direction) {
    std::optional<double> direction_deg = line.wind.direction_deg;
    if (direction_deg) *direction_deg += std::fmod(settings_.north_offset_deg + 360.0, 360.0);
    held_.hold_direction(direction_deg, now);
  }
  if (line.names_gust) held_.hold_gust(line.wind.gust_m_s, now);
}

Sensor::Judgement LineSensor::judge(std::string_view line, const Instant& now) {
  if (!is_text(line)) {
    follows_garbage_ = true;
    return decode::Refusal::kMalformed;
  }
  const bool is_doubtful = std::exchange(follows_garbage_, false);
  const auto read = decode::text::read_line(settings_.line, line);
  if (!read) return read.error();
  if (!has_known_shape(line) || is_doubtful) return decode::Refusal::kMalformed;

  hold(*read, now.mono);
  const decode::DecodedWind& wind = read->wind;
  if (wind.speed_m_s) {
    without_speed_.clear();
    const auto reading = held_.reading_of(*wind.speed_m_s, now);
    if (!reading) return reading.error();
    return std::optional(*reading);
  }
  if (read->names_speed) return decode::Refusal::kInvalid;
  if (!wind.direction_deg && !wind.gust_m_s) return read->direction_refusal.value_or(decode::Refusal::kInvalid);
  if (without_speed_.empty()) without_speed_ = line;
  return std::optional<wind::Reading>();
}

std::string LineSensor::reported_trouble() const {
  if (without_speed_.empty()) return {};
  return fmt::format("lines arrive from {}, but none with a speed (\"{}\" has none): check {}",
                     describe(settings_.text.address), shown(without_speed_), kSpeedKeys);
}

std::string LineSensor::advice(decode::Refusal why, std::string_view line) const {
  if (why != decode::Refusal::kInvalid) return Sensor::advice(why, line);
  return fmt::format(
      "lines arrive from {}, but without a value for the speed (the first: \"{}\"): check {}, and the "
      "device",
      describe(settings_.text.address), shown(line), kSpeedKeys);
}

}  // namespace yuragi::drivers::text
