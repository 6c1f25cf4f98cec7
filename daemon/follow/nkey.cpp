#include "daemon/follow/nkey.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <openssl/crypto.h>
#include <openssl/evp.h>

namespace yuragi::daemon::follow {
namespace {

constexpr std::string_view kBase32 = "ABCDEFGHIJKLMNOPQRSTUVWXYZ234567";
constexpr std::uint8_t kSeedPrefix = 18 << 3;  // "S"
constexpr std::uint8_t kUserPrefix = 20 << 3;  // "U"
constexpr std::size_t kKeyBytes = 32;
constexpr std::size_t kSeedBytes = 2 + kKeyBytes + 2;  // prefixes, key, CRC

std::optional<std::vector<std::uint8_t>> from_base32(std::string_view text) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() * 5 / 8);
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char character : text) {
    const std::size_t value = kBase32.find(character);
    if (value == std::string_view::npos) return std::nullopt;
    bits = bits << 5U | static_cast<std::uint32_t>(value);
    count += 5;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    bits &= (1U << count) - 1U;
  }
  return bytes;
}

std::string to_base32(std::span<const std::uint8_t> bytes) {
  std::string text;
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const std::uint8_t byte : bytes) {
    bits = bits << 8U | byte;
    count += 8;
    while (count >= 5) {
      count -= 5;
      text += kBase32[bits >> count & 31U];
    }
    bits &= (1U << count) - 1U;
  }
  if (count > 0) text += kBase32[bits << (5U - count) & 31U];
  return text;
}

std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U);
  }
  return static_cast<std::uint16_t>(crc);
}

bool is_user_seed(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != kSeedBytes) return false;
  const std::size_t end = kSeedBytes - 2;
  const unsigned stated = bytes[end] | static_cast<unsigned>(bytes[end + 1]) << 8U;
  // The prefix of the kind stands in the 3 last bits of the first byte and the 5 first of the second.
  const unsigned kind = (bytes[0] & 7U) << 5U | bytes[1] >> 3U;
  return (bytes[0] & 0xf8U) == kSeedPrefix && kind == kUserPrefix && crc16(bytes.first(end)) == stated;
}

}  // namespace

std::optional<std::string> public_nkey(const Secret& seed) {
  auto bytes = from_base32(seed.reveal());
  if (!bytes || !is_user_seed(*bytes)) return std::nullopt;
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(
      EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, nullptr, bytes->data() + 2, kKeyBytes), &EVP_PKEY_free);
  OPENSSL_cleanse(bytes->data(), bytes->size());
  std::array<std::uint8_t, 1 + kKeyBytes + 2> shown{kUserPrefix};
  std::size_t size = kKeyBytes;
  if (!key || EVP_PKEY_get_raw_public_key(key.get(), shown.data() + 1, &size) != 1) return std::nullopt;
  const std::uint16_t crc = crc16(std::span(shown).first(1 + kKeyBytes));
  shown[1 + kKeyBytes] = static_cast<std::uint8_t>(crc);
  shown[2 + kKeyBytes] = static_cast<std::uint8_t>(crc >> 8U);
  return to_base32(shown);
}

}  // namespace yuragi::daemon::follow
