#include "drivers/decode/hid/acurite.hpp"

#include <array>

#include "engine/base/units.hpp"

namespace yuragi::drivers::decode::hid {
namespace {

constexpr std::uint8_t kWithDirection = 1;
constexpr std::uint8_t kWithTemperature = 8;
constexpr unsigned kBestLink = 3;
constexpr unsigned kBatteryWell = 7;

/// Degrees of the sixteen indices, as the vane's code disc has them.
constexpr std::array<double, 16> kAcuriteDirections_deg = {315.0, 247.5, 292.5, 270.0, 337.5, 225.0, 0.0,  202.5,
                                                           67.5,  135.0, 90.0,  112.5, 45.0,  157.5, 22.5, 180.0};

constexpr double kAcuriteTip_mm = 0.254;

double acurite_speed_m_s(unsigned n) {
  return n == 0 ? 0.0 : (0.8278 * n + 1.0) * kMetresPerSecondPerKmh;
}

/// The reason why a report cannot be used. There is no checksum: every mark must be a known one.
std::optional<Refusal> acurite_refusal(ByteSpan report) {
  if (report.empty()) return Refusal::kTooShort;
  if (report[0] != 1) return Refusal::kNotMine;
  if (report.size() < kAcuriteReport1) return Refusal::kTooShort;
  if (report.size() > kAcuriteReport1) return Refusal::kMalformed;

  const bool has_no_sensor = (report[1] & 0x0FU) == 0x0F && report[3] == 0xFF;
  if (has_no_sensor) return Refusal::kInvalid;
  const unsigned contents = report[3] & 0x0FU;
  const unsigned link = report[8] & 0x0FU;
  if (contents != kWithDirection && contents != kWithTemperature) return Refusal::kMalformed;
  if (report[9] != 0x00 && report[9] != 0xFF) return Refusal::kMalformed;
  if (link > kBestLink) return Refusal::kMalformed;
  if (link == 0) return Refusal::kInvalid;
  return std::nullopt;
}

}  // namespace

Result<DecodedWind, Refusal> decode_acurite(ByteSpan report) noexcept {
  if (const auto refusal = acurite_refusal(report)) return *refusal;

  DecodedWind wind;
  wind.speed_m_s = acurite_speed_m_s(((report[4] & 0x1FU) << 3U) | ((report[5] & 0x70U) >> 4U));
  if ((report[3] & 0x0FU) == kWithDirection) wind.direction_deg = kAcuriteDirections_deg[report[5] & 0x0FU];
  if (report[3] >> 4U != kBatteryWell) wind.status = DecodedStatus::kUncertain;
  return checked(wind);
}

std::optional<wind::StationQuantities> decode_acurite_quantities(ByteSpan report) noexcept {
  if (acurite_refusal(report)) return std::nullopt;
  wind::StationQuantities said;
  const unsigned low = report[7] & 0x7FU;
  if ((report[3] & 0x0FU) == kWithDirection) {
    said.rain_total_mm = (((report[6] & 0x3FU) << 7U) | low) * kAcuriteTip_mm;
  } else {
    said.air_temperature_c = (((report[5] & 0x0FU) << 7U) | (report[6] & 0x7FU)) / 18.0 - 40.0;
    said.relative_humidity_percent = low;
  }
  return said;
}

}  // namespace yuragi::drivers::decode::hid
