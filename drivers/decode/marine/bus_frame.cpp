#include "drivers/decode/marine/bus_frame.hpp"

#include <charconv>
#include <system_error>

namespace yuragi::drivers::decode::marine {

/// 3 bits of priority, 2 of data page, 8 of format, 8 that are part of the PGN where the format is 240 or above and the
/// destination's address otherwise, 8 of the sender's address.
BusIdentifier bus_identifier_of(std::uint32_t identifier) noexcept {
  const std::uint32_t pgn = (identifier >> 8U) & 0x3FFFFU;
  const bool has_destination = ((pgn >> 8U) & 0xFFU) < 240U;
  return {.priority = static_cast<std::uint8_t>((identifier >> 26U) & 0x7U),
          .pgn = has_destination ? pgn & 0x3FF00U : pgn,
          .address = static_cast<std::uint8_t>(identifier & 0xFFU)};
}

Result<BusWind, Refusal> decode_bus_frame(const BusFrame& frame) noexcept {
  const BusIdentifier identifier = bus_identifier_of(frame.identifier);
  if (identifier.pgn != kWindDataPgn) return Refusal::kNotMine;
  return decode_wind_data(identifier.address, ByteSpan(frame.data).first(frame.size));
}

std::optional<std::uint32_t> hex_number(std::string_view text, std::size_t digits) noexcept {
  if (text.size() != digits) return {};
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, 16);
  if (error != std::errc() || stop != end) return {};
  return number;
}

}  // namespace yuragi::drivers::decode::marine
