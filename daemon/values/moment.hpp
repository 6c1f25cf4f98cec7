#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/values/grid.hpp"
#include "daemon/values/quantity.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/judging/sensor_state.hpp"
#include "engine/wind/wind_state.hpp"

namespace yuragi::daemon::values {

/// The wind that moves the scenes, or the one that was measured.
enum class Wind : std::uint8_t { kShaped, kReal };
inline constexpr std::array<std::string_view, 2> kWindNames = {"shaped", "real"};

/// What a sensor sent last, and its state.
struct SensorValue {
  static constexpr double kNotSent = std::numeric_limits<double>::quiet_NaN();

  double speed_m_s = kNotSent, direction_deg = kNotSent, age_s = kNotSent;
  wind::judging::SensorState state = wind::judging::SensorState::kConnecting;
  friend bool operator==(const SensorValue&, const SensorValue&) = default;
};

/// The names of an installation's sensors, places and scenes, and its grids, in the order of a Moment's values.
struct Names {
  std::vector<std::string> sensors = {}, places = {}, scenes = {};
  std::vector<Grid> grids = {};
  friend bool operator==(const Names&, const Names&) = default;
};

/// The place of a name; nullopt: it is not there.
std::optional<std::size_t> index_of(std::span<const std::string> names, std::string_view name) noexcept;

/// An [[alert]] of the configuration.
struct AlertState {
  std::string name = {};
  bool is_on = false;
  friend bool operator==(const AlertState&, const AlertState&) = default;
};

/// How the daemon is.
struct Health {
  std::vector<AlertState> alerts = {};
  bool needs_attention = false;
  friend bool operator==(const Health&, const Health&) = default;
};

/// Everything that feeds send of one tick. Immutable once published; shared by all threads that send it.
struct Moment {
  std::uint64_t tick = 0;  ///< of the wind; counts from the start, without gaps
  double time_s = 0.0;     ///< since the start, by a steady clock
  MonoTime mono{};
  UtcTime utc{};
  wind::Source source = wind::Source::kDefault;
  Readout shaped, real;
  std::shared_ptr<const Names> names = std::make_shared<const Names>();
  std::vector<SensorValue> sensors = {};
  std::vector<Readout> shaped_places = {}, real_places = {};  ///< real_places: empty unless they are asked for
  std::vector<double> opacities = {};                         ///< of the scenes; empty: there are none
  std::vector<std::vector<double>> grids = {};                ///< of the shaped wind, a value for each point
  double openness = 1.0;                                      ///< of the opening hours; 0: closed, 1: open
  std::shared_ptr<const Health> health = std::make_shared<const Health>();

  const Readout& wind(Wind which) const noexcept { return which == Wind::kShaped ? shaped : real; }
  std::span<const Readout> places(Wind which) const noexcept {
    return which == Wind::kShaped ? shaped_places : real_places;
  }
};

/// ISO 8601 with milliseconds: "2026-11-29T02:40:14.250Z".
std::string utc_text(UtcTime utc);

/// "live", "handover" or "default".
std::string_view name_of(wind::Source source) noexcept;

}  // namespace yuragi::daemon::values
