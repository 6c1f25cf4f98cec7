#include "drivers/text/chosen_wind.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "engine/base/fields.hpp"

namespace yuragi::drivers::text {
namespace {

/// The first is any; then in the order of WindFrame.
constexpr std::array<std::string_view, 4> kChosenFrames = {"auto", "north", "relative", "true"};

/// Below this no vane turns, and anemometers leave out the direction.
constexpr double kCalm_m_s = 0.5;
/// A direction and a speed in two messages belong together if they arrive within this time, or within one and a half
/// pauses of the directions.
constexpr Nanoseconds kJoinTime = std::chrono::seconds(2);

bool is_calm(std::optional<double> speed_m_s) {
  return speed_m_s && *speed_m_s < kCalm_m_s;
}

std::optional<WindFrame> frame_named(const std::string& word) {
  const auto at = std::ranges::find(kChosenFrames, word) - kChosenFrames.begin();
  return at > 0 ? std::optional(static_cast<WindFrame>(at - 1)) : std::nullopt;
}

const Fields<ChosenWindSettings>& chosen_wind_fields() {
  static const Fields<ChosenWindSettings> kChosenFields = {
      {{.name = "reference",
        .default_value = std::string("auto"),
        .help =
            "which wind to use if several are sent: from north, relative to the device's mark or the bow "
            "(apparent), true (from the bow, without the vessel's own motion); auto: the first of these that is sent",
        .choices = kChosenFrames},
       &ChosenWindSettings::frame,
       frame_named},
      {{"north_offset", "deg", 0.0, -360.0, 360.0,
        "bearing of the device's north mark, clockwise from north: added to relative and true directions"},
       &ChosenWindSettings::north_offset_deg},
      {{"variation", "deg", 0.0, -180.0, 180.0,
        "magnetic variation of the place, east positive: added to magnetic directions"},
       &ChosenWindSettings::variation_deg},
  };
  return kChosenFields;
}

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

std::span<const Parameter> chosen_wind_parameters() {
  return chosen_wind_fields().parameters();
}

ChosenWindSettings chosen_wind_settings_of(const ParameterValues& values) {
  return chosen_wind_fields().of(values);
}

sensor::SelectedPart reference_part(const ChosenWindSettings& settings) {
  return {.key = "reference",
          .value = settings.frame ? std::string(kChosenFrames.at(1 + static_cast<std::size_t>(*settings.frame))) : ""};
}

Result<std::optional<wind::Reading>, decode::Refusal> ChosenWind::offer(const WindChoice::Source& source,
                                                                        const decode::DecodedWind& wind,
                                                                        const Instant& now) {
  using Offered = std::optional<wind::Reading>;
  const WindChoice::Said said = {.has_speed = wind.speed_m_s.has_value(),
                                 .has_direction = wind.direction_deg.has_value(),
                                 .is_calm = is_calm(wind.speed_m_s)};
  const auto verdict = choice_.offer(source, said, now.mono);
  if (verdict == WindChoice::Verdict::kForeign) return decode::Refusal::kNotMine;

  // The speed may come in another message than the direction.
  std::optional<double> direction_deg =
      choice_.takes_direction() ? direction_from_north_deg(settings_, wind) : std::nullopt;
  if (direction_deg) {
    kept_direction_ = KeptDirection{source.name, *direction_deg, now.mono, !said.has_speed};
    if (held_ && !held_->direction_deg) held_->direction_deg = direction_deg;
  }
  if (verdict == WindChoice::Verdict::kPass) return Offered();
  if (!direction_deg) direction_deg = direction_for(source.name, now.mono);

  const bool is_uncertain = wind.status == decode::DecodedStatus::kUncertain;
  const wind::Reading reading = {
      .time = now,
      .speed_m_s = wind.speed_m_s.value(),
      .direction_deg = direction_deg,
      .gust_m_s = wind.gust_m_s,
      .quality = is_uncertain ? wind::ReadingQuality::kUncertain : wind::ReadingQuality::kGood};
  name_sources(source.name, reading);
  if (verdict == WindChoice::Verdict::kHold && settings_.comes_in_bursts) {
    held_ = reading;
    return Offered();
  }
  held_.reset();
  return Offered(reading);
}

std::optional<wind::Reading> ChosenWind::take_held() {
  if (held_) choice_.settle();
  return std::exchange(held_, std::nullopt);
}

void ChosenWind::restart() {
  choice_.restart();
  held_.reset();
  kept_direction_.reset();
}

/// The direction that belongs to a speed whose own message has none. In a calm a message leaves it out on purpose: then
/// the one before does not hold.
std::optional<double> ChosenWind::direction_for(const std::string& source, MonoTime now) {
  if (!kept_direction_) return std::nullopt;
  const KeptDirection kept = *kept_direction_;
  if (kept.came_alone) kept_direction_.reset();
  const Nanoseconds longest = std::max<Nanoseconds>(kJoinTime, choice_.direction_pause() * 3 / 2);
  if (now - kept.time > longest || (kept.source == source && !kept.came_alone)) return std::nullopt;
  return kept.direction_deg;
}

void ChosenWind::name_sources(const std::string& source, const wind::Reading& reading) {
  const std::string& direction_source = choice_.direction_source();
  if (direction_source.empty() || direction_source == source) {
    taken_ = source;
  } else if (reading.direction_deg) {
    taken_ = fmt::format("{} with the direction of {}", source, direction_source);
  } else if (!is_calm(reading.speed_m_s)) {
    taken_ = fmt::format("{} without a direction, because {} has none", source, direction_source);
  }
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
