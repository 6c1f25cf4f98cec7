#include "drivers/decode/network/ecowitt.hpp"

#include <array>
#include <bitset>
#include <optional>

namespace yuragi::drivers::decode::network {
namespace {

constexpr std::uint8_t kLiveData = 0x27;
constexpr std::size_t kHead = 5;  // mark, command, size
constexpr std::size_t kMark = 2;  // is not in the size
constexpr std::size_t kChecksum = 1;
constexpr std::uint16_t kNoValue = 0xFFFF;
constexpr std::uint8_t kUnknownLength = 0;

/// The ids of items that are used.
enum ItemId : std::uint8_t {
  kTemperature = 0x02,
  kHumidity = 0x07,
  kPressure = 0x08,
  kDirection = 0x0A,
  kSpeed = 0x0B,
  kGust = 0x0C,
  kRainRate = 0x0E,
  kRainOfYear = 0x13,
  kRainTotal = 0x14,
  kPiezoRainRate = 0x80,
  kPiezoRainOfYear = 0x86,
};

/// Ids from `first` on, up to and with `last`, in steps of `step`, and the length of each.
struct ItemLengths {
  std::uint8_t first;
  std::uint8_t last;
  std::uint8_t step;
  std::uint8_t length;
};
constexpr std::array<ItemLengths, 26> kItemLengths = {{
    {0x01, 0x05, 1, 2},   // temperatures
    {0x06, 0x07, 1, 1},   // humidities
    {0x08, 0x11, 1, 2},   // pressures, wind, rain
    {0x12, 0x15, 1, 4},   // rain, light
    {0x16, 0x16, 1, 2},   // ultraviolet light
    {0x17, 0x17, 1, 1},   // its index
    {0x18, 0x18, 1, 6},   // date and time
    {0x19, 0x21, 1, 2},   // greatest wind of the day; temperatures of channels
    {0x22, 0x29, 1, 1},   // humidities of channels
    {0x2A, 0x2A, 1, 2},   // particles
    {0x2B, 0x49, 2, 2},   // temperatures of soil
    {0x2C, 0x4A, 2, 1},   // its moisture
    {0x4C, 0x4C, 1, 16},  // batteries
    {0x4D, 0x53, 1, 2},   // particles
    {0x58, 0x5B, 1, 1},   // leaks
    {0x60, 0x60, 1, 1},   // distance of lightning
    {0x61, 0x62, 1, 4},   // its time and number
    {0x63, 0x6A, 1, 3},   // temperatures of probes
    {0x6C, 0x6C, 1, 4},   // free memory
    {0x70, 0x70, 1, 16},  // carbon dioxide
    {0x72, 0x79, 1, 1},   // wetness of leaves
    {0x7A, 0x7B, 1, 1},   // settings
    {0x80, 0x82, 1, 2},   // piezo rain
    {0x83, 0x86, 1, 4},   // the same, sums
    {0x87, 0x87, 1, 20},  // its gains
    {0x88, 0x88, 1, 3},   // when its sums are set back
}};

std::uint8_t length_of_item(std::uint8_t id) {
  for (const ItemLengths& some : kItemLengths) {
    if (id >= some.first && id <= some.last && (id - some.first) % some.step == 0) return some.length;
  }
  return kUnknownLength;
}

/// The positions of a reply's values, by their ids.
class Items {
 public:
  /// Reads them up to the first of unknown id. Returns nullopt if one is cut off or comes twice.
  static std::optional<Items> of(ByteSpan bytes) {
    Items items;
    std::bitset<256> seen;
    while (!bytes.empty()) {
      const std::uint8_t id = bytes[0];
      const std::size_t length = length_of_item(id);
      if (length == kUnknownLength) break;
      if (bytes.size() < 1 + length || seen[id]) return std::nullopt;
      seen[id] = true;
      items.values_[id] = bytes.subspan(1, length);
      bytes = bytes.subspan(1 + length);
    }
    return items;
  }

  /// Unsigned numbers of the items' own lengths; nullopt if the item is missing.
  std::optional<double> number(ItemId id, double unit) const {
    if (values_[id].empty()) return std::nullopt;
    std::uint32_t number = 0;
    for (const std::uint8_t byte : values_[id]) number = (number << 8U) | byte;
    return number * unit;
  }
  /// The same of 16 bits with the mark for none.
  std::optional<double> wind_number(ItemId id, double unit) const {
    if (values_[id].empty() || big_endian_16(values_[id], 0) == kNoValue) return std::nullopt;
    return number(id, unit);
  }
  std::optional<double> signed_number(ItemId id, double unit) const {
    if (values_[id].empty()) return std::nullopt;
    return static_cast<std::int16_t>(big_endian_16(values_[id], 0)) * unit;
  }

 private:
  std::array<ByteSpan, 256> values_{};
};

Result<DecodedWind, Refusal> wind_of_items(const Items& items) {
  DecodedWind wind = {
      .speed_m_s = items.wind_number(kSpeed, 0.1), .direction_deg = {}, .gust_m_s = items.wind_number(kGust, 0.1)};
  if (!wind.speed_m_s) return Refusal::kInvalid;
  if (const auto direction_deg = items.wind_number(kDirection, 1.0)) {
    wind.direction_deg = wrapped_direction_deg(*direction_deg);
    if (!wind.direction_deg) wind.status = DecodedStatus::kUncertain;  // the speed is still one
  }
  return checked(wind);
}

/// The first of them that is there.
std::optional<double> first_of(std::optional<double> first, std::optional<double> second) {
  return first ? first : second;
}

wind::StationQuantities quantities_of_items(const Items& items) {
  wind::StationQuantities said;
  said.air_temperature_c = items.signed_number(kTemperature, 0.1);
  said.relative_humidity_percent = items.number(kHumidity, 1.0);
  said.pressure_hpa = items.number(kPressure, 0.1);
  said.rain_rate_mm_h = first_of(items.number(kRainRate, 0.1), items.number(kPiezoRainRate, 0.1));
  said.rain_total_mm = first_of(items.number(kRainTotal, 0.1),
                                first_of(items.number(kRainOfYear, 0.1), items.number(kPiezoRainOfYear, 0.1)));
  return said;
}

}  // namespace

Result<std::size_t, Refusal> ecowitt_reply_size(ByteSpan beginning) noexcept {
  for (std::size_t at = 0; at < kMark && at < beginning.size(); ++at) {
    if (beginning[at] != 0xFF) return Refusal::kMalformed;
  }
  if (beginning.size() > kMark && beginning[kMark] != kLiveData) return Refusal::kNotMine;
  if (beginning.size() < kHead) return Refusal::kTooShort;
  const std::size_t size = kMark + big_endian_16(beginning, 3);
  if (size < kHead + kChecksum || size > kMaxEcowittReply) return Refusal::kMalformed;
  return size;
}

Result<EcowittValues, Refusal> decode_ecowitt(ByteSpan reply) noexcept {
  const auto size = ecowitt_reply_size(reply);
  if (!size) return size.error();
  if (reply.size() < *size) return Refusal::kTooShort;
  if (reply.size() > *size) return Refusal::kMalformed;
  const auto sum = static_cast<std::uint8_t>(sum_16(reply.subspan(kMark, *size - kMark - kChecksum)) & 0xFFU);
  if (sum != reply.back()) return Refusal::kBadChecksum;

  const auto items = Items::of(reply.subspan(kHead, *size - kHead - kChecksum));
  if (!items) return Refusal::kMalformed;
  return EcowittValues{.quantities = quantities_of_items(*items), .wind = wind_of_items(*items)};
}

}  // namespace yuragi::drivers::decode::network
