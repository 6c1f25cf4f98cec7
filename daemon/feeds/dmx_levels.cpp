#include "daemon/feeds/dmx_levels.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::daemon::feeds {
namespace {

/// A fan that turns goes on down to this part of the level at which it begins.
constexpr double kOffBelow = 0.75;

}  // namespace

double DmxChannelLevel::wanted(double value) {
  const double level = channel_.to.at(std::pow(channel_.from.part_of(value), channel_.curve));
  if (channel_.least <= 0.0) return level;
  is_on_ = level >= (is_on_ ? kOffBelow * channel_.least : channel_.least);
  return is_on_ ? std::max(level, channel_.least) : 0.0;
}

void DmxChannelLevel::step(std::optional<double> value, double dt_s) {
  const double next = value ? wanted(*value) : channel_.rest;
  if (!value) is_on_ = false;
  if (channel_.slew_s <= 0.0) {
    level_ = next;
    return;
  }
  const double most = channel_.max_level() * std::max(dt_s, 0.0) / channel_.slew_s;
  level_ += std::clamp(next - level_, -most, most);
}

void DmxChannelLevel::write_to(DmxLevels& levels) const noexcept {
  const auto level = static_cast<unsigned>(std::lround(std::clamp(level_, 0.0, channel_.max_level())));
  const std::size_t first = channel_.channel - 1;
  if (channel_.bits == 16) {
    levels[first] = static_cast<std::uint8_t>(level >> 8U);
    levels[first + 1] = static_cast<std::uint8_t>(level);
  } else {
    levels[first] = static_cast<std::uint8_t>(level);
  }
}

void write_grid(const settings::feeds::DmxGrid& grid, std::span<const double> values,
                std::span<DmxLevels> universes) noexcept {
  for (std::size_t pixel = 0; pixel < grid.grid.size(); ++pixel) {
    const settings::feeds::DmxGrid::Where where = grid.where(pixel);
    const double part = pixel < values.size() ? std::pow(grid.from.part_of(values[pixel]), grid.curve) : 0.0;
    for (std::size_t i = 0; i < grid.rest.size(); ++i) {
      const double from = grid.to.from[i], to = grid.to.to[i];
      universes[where.universe][where.channel - 1 + i] =
          pixel < values.size() ? static_cast<std::uint8_t>(std::lround(from + (to - from) * part)) : grid.rest[i];
    }
  }
}

}  // namespace yuragi::daemon::feeds
