#pragma once

#include <optional>
#include <span>
#include <string>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/sensor/value_selection.hpp"
#include "drivers/text/wind_choice.hpp"
#include "engine/base/parameter.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::text {

/// Which winds are taken, and how their angles are turned to north.
struct ChosenWindSettings {
  std::optional<WindFrame> frame;  ///< accept only this frame; nullopt: the best received
  double north_offset_deg = 0.0;   ///< what to add to a direction from the device's own mark
  double variation_deg = 0.0;      ///< what to add to a direction from magnetic north
  bool comes_in_bursts = true;     ///< the first of several winds waits for a better one of the same burst
};

/// The parameters of these: reference, north_offset, variation.
std::span<const Parameter> chosen_wind_parameters();
ChosenWindSettings chosen_wind_settings_of(const ParameterValues& values);

/// The selection by the setting "reference".
sensor::SelectedPart reference_part(const ChosenWindSettings& settings);

/// The frame in which a direction of that reference is. Thread-safe and realtime-safe: yes.
WindFrame frame_of_reference(decode::WindReference reference) noexcept;

/// Returns the direction from true north, if the settings have the device's orientation; nullopt if there is none.
/// Thread-safe and realtime-safe: yes.
std::optional<double> direction_from_north_deg(const ChosenWindSettings& settings,
                                               const decode::DecodedWind& wind) noexcept;

/// Makes one wind of the messages of several sources, each in its own frame (WindChoice), with directions from north.
/// Speed and direction may come from different sources, in messages of their own. Thread-safe: no.
class ChosenWind {
 public:
  explicit ChosenWind(const ChosenWindSettings& settings) : settings_(settings), choice_(settings.frame) {}

  /// Takes a source's wind. Returns what to publish now: nullopt if it has no speed, is another source's wind, or is
  /// held until the first burst is over. kNotMine: not in the configured frame.
  Result<std::optional<wind::Reading>, decode::Refusal> offer(const WindChoice::Source& source,
                                                              const decode::DecodedWind& wind, const Instant& now);
  /// The same of a source whose frame is that of its direction.
  Result<std::optional<wind::Reading>, decode::Refusal> offer(const std::string& source,
                                                              const decode::DecodedWind& wind, const Instant& now) {
    return offer({.name = source, .frame = frame_of_reference(wind.reference)}, wind, now);
  }
  /// Call when the burst is over: returns the held reading.
  std::optional<wind::Reading> take_held();
  /// The device was opened again.
  void restart();

  /// The sources of speed and direction that were taken last, for people: a change of it is logged. Empty: none yet.
  const std::string& taken() const noexcept { return taken_; }

 private:
  /// The last direction that was taken, kept for the speeds that follow.
  struct KeptDirection {
    std::string source;
    double direction_deg = 0.0;
    MonoTime time{};
    bool came_alone = false;  ///< in a message without a speed
  };

  std::optional<double> direction_for(const std::string& source, MonoTime now);
  void name_sources(const std::string& source, const wind::Reading& reading);

  ChosenWindSettings settings_;
  WindChoice choice_;
  std::optional<wind::Reading> held_;
  std::optional<KeptDirection> kept_direction_;
  std::string taken_;
};

}  // namespace yuragi::drivers::text
