#include "drivers/sensor/held_wind.hpp"

#include "drivers/decode/decoded_wind.hpp"

namespace yuragi::drivers::sensor {

void HeldWind::clear() noexcept {
  direction_deg_ = {};
  gust_m_s_ = {};
  is_lost_ = false;
}

bool HeldWind::hold_direction(std::optional<double> direction_deg, MonoTime now) noexcept {
  const auto wrapped_deg = direction_deg ? decode::wrapped_direction_deg(*direction_deg) : std::nullopt;
  direction_deg_ = {.value = wrapped_deg, .since = now};
  is_lost_ = direction_deg && !wrapped_deg;
  return !is_lost_;
}

void HeldWind::lose_direction(MonoTime now) noexcept {
  direction_deg_ = {.value = std::nullopt, .since = now};
  is_lost_ = true;
}

bool HeldWind::hold_gust(std::optional<double> gust_m_s, MonoTime now) noexcept {
  gust_m_s_ = {.value = std::nullopt, .since = now};
  if (!gust_m_s) return true;
  decode::DecodedWind wind;
  wind.gust_m_s = gust_m_s;
  if (!decode::checked(wind)) return false;
  gust_m_s_.value = gust_m_s;
  return true;
}

Result<wind::Reading, decode::Refusal> HeldWind::reading_of(double speed_m_s, const Instant& now) const noexcept {
  decode::DecodedWind wind;
  wind.speed_m_s = speed_m_s;
  wind.direction_deg = still_held(direction_deg_, now.mono);
  wind.gust_m_s = still_held(gust_m_s_, now.mono);
  const auto plausible = decode::checked(wind);
  if (!plausible) return plausible.error();
  const bool is_uncertain = is_lost_ && now.mono - direction_deg_.since <= hold_;
  return wind::Reading{.time = now,
                       .speed_m_s = *plausible->speed_m_s,
                       .direction_deg = plausible->direction_deg,
                       .gust_m_s = plausible->gust_m_s,
                       .quality = is_uncertain ? wind::ReadingQuality::kUncertain : wind::ReadingQuality::kGood};
}

std::optional<double> HeldWind::still_held(const Held& held, MonoTime now) const noexcept {
  return now - held.since <= hold_ ? held.value : std::nullopt;
}

}  // namespace yuragi::drivers::sensor
