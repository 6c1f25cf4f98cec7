#include "drivers/text/chosen_wind.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace yuragi::drivers::text {
namespace {

constexpr std::array<std::string_view, 4> kChosenFrames = {"auto", "north", "relative", "true"};

/// In a slower wind no vane turns.
constexpr double kCalm_m_s = 0.5;
/// A direction of another source holds for so long, or for one and a half of its own pauses.
constexpr Nanoseconds kDirectionHolds = std::chrono::seconds(2);

}  // namespace

WindFrame frame_of_reference(decode::WindReference reference) noexcept {
  switch (reference) {
    case decode::WindReference::kNorth:
    case decode::WindReference::kMagnetic:
      return WindFrame::kNorth;
    case decode::WindReference::kTrue:
      return WindFrame::kTrue;
    case decode::WindReference::kRelative:
    case decode::WindReference::kUnknown:
      break;
  }
  return WindFrame::kRelative;
}

std::vector<Parameter> chosen_wind_parameters() {
  return {
      {.name = "reference",
       .unit = "",
       .default_value = std::string("auto"),
       .help =
           "which wind to use where several are sent: from north, relative to the device's mark or the bow "
           "(apparent), true (from the bow, without the vessel's own motion); auto: the first of these that is sent",
       .choices = kChosenFrames},
      {.name = "north_offset",
       .unit = "deg",
       .default_value = 0.0,
       .min = -360.0,
       .max = 360.0,
       .help = "bearing of the device's north mark, clockwise from north: added to relative and true directions"},
      {.name = "variation",
       .unit = "deg",
       .default_value = 0.0,
       .min = -180.0,
       .max = 180.0,
       .help = "magnetic variation of the place, east positive: added to magnetic directions"},
  };
}

ChosenWindSettings chosen_wind_settings_of(const ParameterValues& values) {
  ChosenWindSettings settings;
  const std::string& reference = values.text("reference");
  if (reference == "north") settings.frame = WindFrame::kNorth;
  if (reference == "relative") settings.frame = WindFrame::kRelative;
  if (reference == "true") settings.frame = WindFrame::kTrue;
  settings.north_offset_deg = values.number("north_offset");
  settings.variation_deg = values.number("variation");
  return settings;
}

Result<std::optional<wind::WindReading>, decode::Refusal> ChosenWind::offer(const std::string& source,
                                                                            const decode::DecodedWind& wind,
                                                                            const Instant& now) {
  using Offered = std::optional<wind::WindReading>;
  const WindChoice::Said said = {.has_speed = wind.speed_m_s.has_value(),
                                 .has_direction = wind.direction_deg.has_value(),
                                 .is_calm = wind.speed_m_s && *wind.speed_m_s < kCalm_m_s};
  const auto verdict = choice_.offer({.name = source, .frame = frame_of_reference(wind.reference)}, said, now.mono);
  if (verdict == WindChoice::Verdict::kForeign) return decode::Refusal::kNotMine;

  // The speed may be another source's than the direction.
  std::optional<double> direction_deg =
      choice_.takes_direction() ? direction_from_north_deg(settings_, wind) : std::nullopt;
  if (direction_deg) {
    kept_direction_ = KeptDirection{source, *direction_deg, now.mono};
    if (held_ && !held_->direction_deg) held_->direction_deg = direction_deg;
  }
  if (verdict == WindChoice::Verdict::kPass) return Offered();
  if (!direction_deg) direction_deg = direction_for(source, now.mono);

  const bool is_uncertain = wind.status == decode::DecodedStatus::kUncertain;
  const wind::WindReading reading = {
      .time = now,
      .speed_m_s = wind.speed_m_s.value(),
      .direction_deg = direction_deg,
      .gust_m_s = wind.gust_m_s,
      .quality = is_uncertain ? wind::ReadingQuality::kUncertain : wind::ReadingQuality::kGood};
  taken_ = source;
  if (verdict == WindChoice::Verdict::kHold) {
    held_ = reading;
    return Offered();
  }
  held_.reset();
  return Offered(reading);
}

std::optional<wind::WindReading> ChosenWind::take_held() {
  if (held_) choice_.settle();
  return std::exchange(held_, std::nullopt);
}

void ChosenWind::restart() {
  choice_.restart();
  held_.reset();
  kept_direction_.reset();
}

std::optional<double> ChosenWind::direction_for(const std::string& source, MonoTime now) const {
  const Nanoseconds longest = std::max<Nanoseconds>(kDirectionHolds, choice_.direction_pause() * 3 / 2);
  const bool holds = kept_direction_ && kept_direction_->source != source && now - kept_direction_->time <= longest;
  return holds ? std::optional(kept_direction_->direction_deg) : std::nullopt;
}

std::optional<double> direction_from_north_deg(const ChosenWindSettings& settings,
                                               const decode::DecodedWind& wind) noexcept {
  if (!wind.direction_deg) return {};
  double turn_deg = settings.north_offset_deg;
  if (wind.reference == decode::WindReference::kNorth) turn_deg = 0.0;
  if (wind.reference == decode::WindReference::kMagnetic) turn_deg = settings.variation_deg;
  const double turned_deg = std::fmod(*wind.direction_deg + turn_deg, 360.0);
  return decode::wrapped_direction_deg(turned_deg < 0.0 ? turned_deg + 360.0 : turned_deg);
}

}  // namespace yuragi::drivers::text
