#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/feeds/span.hpp"
#include "daemon/values/moment.hpp"
#include "daemon/values/reference.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::settings::feeds {

/// An [[osc.map]]: a value, brought from one range into another, at an address of the receiver's own.
struct OscMap {
  std::string value_text = {};
  std::string address = {};
  std::optional<Span> given_from = {};
  Span from = {}, to = {};
  double curve = 1.0;
  double smooth_s = 0.0;
  values::Reference value{};  ///< of value_text
  friend bool operator==(const OscMap& one, const OscMap& other) {
    return one.value_text == other.value_text && one.address == other.address && one.from == other.from &&
           one.to == other.to && one.curve == other.curve && one.smooth_s == other.smooth_s;
  }
};

/// What sends a cue.
enum class OscCondition : std::uint8_t { kGust, kWindAbove, kCalm, kSensorSilent };
inline constexpr std::array<std::string_view, 4> kOscConditionNames = {"gust", "wind_above", "calm", "sensor_silent"};

/// An [[osc.cue]]: a message without arguments, when something happens.
struct OscCue {
  OscCondition when = OscCondition::kGust;
  double rise_m_s = 3.0;
  std::optional<double> speed_m_s = {};  ///< of kWindAbove and kCalm; nullopt: the usual one
  std::optional<double> after_s = {};    ///< how long the condition has to hold; nullopt: the usual time
  std::string sensor = {};
  double again_after_s = 20.0;
  std::string address = {};
  friend bool operator==(const OscCue&, const OscCue&) = default;

  double limit_m_s() const;
  double holds_for_s() const;
};

/// An [[osc]]: whom to send what.
struct Osc {
  std::string name = {};
  std::string to = {};  ///< HOST:PORT
  std::optional<double> rate_hz = {};
  std::string send = {};  ///< words of kOscParts, or kOscMappedOnly
  std::string prefix = {};
  bool bundles = true;
  bool time_tags = false;
  values::Wind wind = values::Wind::kShaped;
  std::vector<OscMap> maps = {};
  std::vector<OscCue> cues = {};
  friend bool operator==(const Osc&, const Osc&) = default;

  bool sends(std::string_view part) const;
};
inline constexpr std::array<std::string_view, 4> kOscParts = {"wind", "sensors", "places", "scenes"};
inline constexpr std::string_view kOscMappedOnly = "mapped";

std::span<const Parameter> osc_parameters();
std::span<const Parameter> osc_map_parameters();
std::span<const Parameter> osc_cue_parameters();

/// From values of these parameters. An error names the key.
Result<Osc, ParameterError> osc_of(std::string name, const ParameterValues& values);
Result<OscMap, ParameterError> osc_map_of(const ParameterValues& values, const values::Names& names);
Result<OscCue, ParameterError> osc_cue_of(const ParameterValues& values, const values::Names& names);

}  // namespace yuragi::daemon::settings::feeds
