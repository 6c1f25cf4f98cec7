#include "drivers/decode/marine/yacht_devices.hpp"

#include "drivers/decode/marine/bus_frame.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

constexpr std::size_t kTime = 0;
constexpr std::size_t kWay = 1;
constexpr std::size_t kIdentifier = 2;
constexpr std::size_t kData = 3;
constexpr std::string_view kTimeShape = "00:00:00.000";
constexpr std::uint32_t kMaxIdentifier = 0x1FFFFFFF;

bool is_time(std::string_view text) {
  if (text.size() != kTimeShape.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_digit = text[i] >= '0' && text[i] <= '9';
    if (kTimeShape[i] == '0' ? !is_digit : text[i] != kTimeShape[i]) return false;
  }
  return true;
}

}  // namespace

bool looks_like_yacht_devices(std::string_view line) noexcept {
  const TextFields fields = split_fields(trimmed(line), ' ');
  return is_time(fields[kTime]) && (fields[kWay] == "R" || fields[kWay] == "T");
}

Result<BusWind, Refusal> decode_yacht_devices(std::string_view line) noexcept {
  const TextFields fields = split_fields(trimmed(line), ' ');
  if (fields.count <= kData) return Refusal::kTooShort;
  const auto identifier = hex_number(fields[kIdentifier], 8);
  if (!looks_like_yacht_devices(line) || !identifier || *identifier > kMaxIdentifier) return Refusal::kMalformed;

  BusFrame frame = {.identifier = *identifier};
  if (fields.count > kData + frame.data.size()) return Refusal::kMalformed;
  for (std::size_t field = kData; field < fields.count; ++field) {
    const auto byte = hex_number(fields[field], 2);
    if (!byte) return Refusal::kMalformed;
    frame.data[frame.size++] = static_cast<std::uint8_t>(*byte);
  }
  if (fields[kWay] != "R") return Refusal::kNotMine;
  return decode_bus_frame(frame);
}

}  // namespace yuragi::drivers::decode::marine
