#include "drivers/decode/network/ecowitt_gateway.hpp"

#include <numeric>
#include <string_view>

#include "engine/base/printable_text.hpp"

namespace yuragi::drivers::decode::network {
namespace {

constexpr std::uint8_t kSearchCommand = 0x12;
constexpr std::size_t kMacAt = 5;
constexpr std::size_t kPortAt = 15;
constexpr std::size_t kNameAt = 18;
constexpr std::size_t kMaxName = 64;

}  // namespace

Result<EcowittGateway, Refusal> decode_ecowitt_gateway(ByteSpan answer) {
  if (answer.size() <= kNameAt) return Refusal::kTooShort;
  if (answer[0] != 0xFF || answer[1] != 0xFF) return Refusal::kMalformed;
  if (answer[2] != kSearchCommand) return Refusal::kNotMine;
  // Recorded answers count from the command to the name; the maker's document counts the checksum, too (S9.20).
  const std::size_t size = big_endian_16(answer, 3);
  if (answer.size() < size + 2) return Refusal::kTooShort;
  if (answer.size() > size + 3) return Refusal::kMalformed;
  const ByteSpan summed = answer.subspan(2, answer.size() - 3);
  if (static_cast<std::uint8_t>(std::accumulate(summed.begin(), summed.end(), 0U)) != answer.back())
    return Refusal::kBadChecksum;

  EcowittGateway gateway;
  for (const std::uint8_t byte : answer.subspan(kMacAt, 6)) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    if (!gateway.mac.empty()) gateway.mac += ':';
    gateway.mac += {kDigits[byte >> 4U], kDigits[byte & 0xFU]};
  }
  gateway.port = big_endian_16(answer, kPortAt);
  if (gateway.port == 0) return Refusal::kMalformed;
  const ByteSpan name = answer.subspan(kNameAt, answer.size() - kNameAt - 1);
  gateway.name.assign(name.begin(), name.end());
  make_printable(gateway.name);
  gateway.name = shortened(gateway.name, kMaxName);
  return gateway;
}

}  // namespace yuragi::drivers::decode::network
