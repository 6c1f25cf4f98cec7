#include "engine/wind/ground/wind_tape.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::wind::ground {
namespace {

double between_numbers(double first, double second, double fraction) noexcept {
  return first + fraction * (second - first);
}

template <std::size_t count>
void between_lanes(const std::array<float, count>& first, const std::array<float, count>& second, float fraction,
                   std::array<float, count>& out) noexcept {
  for (std::size_t i = 0; i < count; ++i) out[i] = first[i] + fraction * (second[i] - first[i]);
}

}  // namespace

WindSample between(const WindSample& first, const WindSample& second, double fraction) noexcept {
  WindSample result;
  const auto part = static_cast<float>(fraction);
  between_lanes(first.east_m_s, second.east_m_s, part, result.east_m_s);
  between_lanes(first.north_m_s, second.north_m_s, part, result.north_m_s);
  between_lanes(first.known_along, second.known_along, part, result.known_along);
  between_lanes(first.known_across, second.known_across, part, result.known_across);
  result.mean = first.mean + fraction * (second.mean - first.mean);
  result.way = first.way + fraction * (second.way - first.way);
  result.east_m = between_numbers(first.east_m, second.east_m, fraction);
  result.south_m = between_numbers(first.south_m, second.south_m, fraction);
  result.gain = between_numbers(first.gain, second.gain, fraction);
  return result;
}

void WindTape::write(const WindPen& pen, double way_m) noexcept {
  const std::int64_t reached = newest_at(way_m);
  now_ = pen.now;
  if (!has_begun_ || way_m < way_m_) {
    has_begun_ = true;
    WindSample blank = pen.written;
    blank.east_m_s = blank.north_m_s = {};
    blank.known_along = blank.known_across = {};
    std::ranges::fill(samples_, blank);
    newest_ = reached;
  } else {
    newest_ = std::max(newest_, reached - kSamples);
    while (newest_ < reached) {
      ++newest_;
      const double passed = (static_cast<double>(newest_) * kStep_m - way_m_) / (way_m - way_m_);
      sample(newest_) = between(last_written_, pen.written, passed);
    }
  }
  last_written_ = pen.written;
  way_m_ = way_m;

  const double place = way_m / kStep_m - 1.0;
  const double below = std::floor(place);
  const auto number = static_cast<std::int64_t>(below);
  one_back_ = between(sample(number), sample(number + 1), place - below);
}

}  // namespace yuragi::wind::ground
