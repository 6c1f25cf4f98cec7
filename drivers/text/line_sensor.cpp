#include "drivers/text/line_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace yuragi::drivers::text {
namespace {

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
    : Sensor(settings.text, std::move(port)), settings_(std::move(settings)) {}

void LineSensor::begin() {
  last_shape_.reset();
  follows_garbage_ = false;
}

Sensor::Judgement LineSensor::judge(std::string_view line, const Instant& now) {
  if (!is_text(line)) {
    follows_garbage_ = true;
    return decode::Refusal::kMalformed;
  }
  const bool is_doubtful = std::exchange(follows_garbage_, false);
  const auto wind = decode::text::decode_line(settings_.line, line);
  if (!wind) return wind.error();

  // The shape of the lines is the one that occurs twice in a row; other lines are refused.
  const std::size_t shape = shape_of(decode::trimmed(line), settings_.line.separator);
  const bool comes_again = std::exchange(last_shape_, shape) == shape;
  if (!shape_ || comes_again) shape_ = shape;
  if (is_doubtful || shape != *shape_) return decode::Refusal::kMalformed;

  if (!wind->speed_m_s) return decode::Refusal::kInvalid;
  std::optional<double> direction_deg = wind->direction_deg;
  if (direction_deg)
    direction_deg =
        decode::wrapped_direction_deg(*direction_deg + std::fmod(settings_.north_offset_deg + 360.0, 360.0));
  return std::optional(wind::Reading{.time = now,
                                     .speed_m_s = *wind->speed_m_s,
                                     .direction_deg = direction_deg,
                                     .gust_m_s = wind->gust_m_s,
                                     .quality = wind::ReadingQuality::kGood});
}

}  // namespace yuragi::drivers::text
