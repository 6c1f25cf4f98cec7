#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/feeds/e131_packet.hpp"
#include "daemon/settings/feeds/dmx.hpp"
#include "daemon/values/moment.hpp"

namespace yuragi::daemon::feeds {

/// The level of a [[dmx.channel]] from moment to moment: its range, curve, hysteresis and slew. Begins at rest. Time is
/// the caller's. Thread-safe: no.
class DmxChannelLevel {
 public:
  explicit DmxChannelLevel(const settings::feeds::DmxChannel& channel) : channel_(channel), level_(channel.rest) {}

  /// Goes on by `dt_s`. `value`: nullopt: there is none, it goes to rest.
  void step(std::optional<double> value, double dt_s);
  /// Goes to rest at once.
  void reset() { level_ = channel_.rest; }
  bool is_at_rest() const noexcept { return level_ == channel_.rest; }
  void write_to(DmxLevels& levels) const noexcept;

  const settings::feeds::DmxChannel& config() const noexcept { return channel_; }

 private:
  double wanted(double value);

  settings::feeds::DmxChannel channel_;
  double level_;
  bool is_on_ = false;  ///< the fan of `least`
};

/// Writes the pixels of a grid into its universes. `values`: of its points; empty: its color of rest.
void write_grid(const settings::feeds::DmxGrid& grid, std::span<const double> values,
                std::span<DmxLevels> universes) noexcept;

}  // namespace yuragi::daemon::feeds
