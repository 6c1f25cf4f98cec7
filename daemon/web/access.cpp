#include "daemon/web/access.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

namespace yuragi::daemon::web {
namespace {

constexpr std::size_t kTokenBytes = 32;
constexpr std::size_t kDigestBytes = 32;
constexpr std::size_t kCodeCharacters = 8;
constexpr std::size_t kBitsACharacter = 5;
constexpr std::size_t kMarkBytes = 16;
// Without I, L, O and U, which are taken for others (D. Crockford, Base 32, 2002).
constexpr std::string_view kCodeAlphabet = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";

using Digest = std::array<unsigned char, kDigestBytes>;

/// HMAC-SHA256 (H. Krawczyk and others, RFC 2104, 1997) of a text for one purpose.
Digest digest_of(const Secret& token, std::string_view purpose, std::string_view text) {
  const std::string message = fmt::format("yuragi {}\n{}", purpose, text);
  const std::string& key = token.reveal();
  Digest digest{};
  unsigned int size = 0;
  const unsigned char* const made =
      HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
           reinterpret_cast<const unsigned char*>(message.data()), message.size(), digest.data(), &size);
  if (made == nullptr || size != digest.size()) throw std::runtime_error("OpenSSL cannot make an HMAC");
  return digest;
}

/// Takes the same time for every difference; only the lengths may be learned.
bool are_same(std::string_view one, std::string_view other) {
  return one.size() == other.size() && CRYPTO_memcmp(one.data(), other.data(), one.size()) == 0;
}

std::string code_of(const Secret& token, std::int64_t step) {
  const Digest digest = digest_of(token, "pairing", std::to_string(step));
  std::uint64_t bits = 0;
  for (std::size_t byte = 0; byte < kCodeCharacters * kBitsACharacter / 8; ++byte) bits = bits << 8U | digest.at(byte);
  std::string code(kCodeCharacters, '0');
  for (char& character : code) {
    character = kCodeAlphabet[bits % kCodeAlphabet.size()];
    bits /= kCodeAlphabet.size();
  }
  return code;
}

std::int64_t step_at(double utc_s) {
  return static_cast<std::int64_t>(std::floor(utc_s / Access::kCodeStep_s));
}

/// As a person may have typed it.
std::string typed_code(std::string_view given) {
  std::string code;
  for (char character : given.substr(0, 4 * kCodeCharacters)) {
    if (character == '-' || character == ' ') continue;
    if (character >= 'a' && character <= 'z') character = static_cast<char>(character - 'a' + 'A');
    if (character == 'O') character = '0';
    if (character == 'I' || character == 'L') character = '1';
    code += character;
  }
  return code;
}

std::string hexadecimal(std::span<const unsigned char> bytes) {
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

template <std::size_t Size>
std::array<unsigned char, Size> random_bytes() {
  std::array<unsigned char, Size> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw std::runtime_error("OpenSSL returns no random bytes");
  return bytes;
}

}  // namespace

Secret Access::new_token() {
  const auto bytes = random_bytes<kTokenBytes>();
  // Base64 as it may stand in a header or an URL.
  std::string text(4 * ((kTokenBytes + 2) / 3), '\0');
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(), static_cast<int>(bytes.size()));
  std::ranges::replace(text, '+', '-');
  std::ranges::replace(text, '/', '_');
  text.erase(text.find('='));
  return Secret(std::move(text));
}

bool Access::is_token(std::string_view given) const {
  // Digests, which are equally long: not even the token's length can be learned.
  const Digest one = digest_of(token_, "token", given);
  const Digest other = digest_of(token_, "token", token_.reveal());
  return CRYPTO_memcmp(one.data(), other.data(), one.size()) == 0;
}

std::string Access::pairing_code(double utc_s) const {
  std::string code = code_of(token_, step_at(utc_s));
  code.insert(kCodeCharacters / 2, 1, '-');
  return code;
}

std::optional<std::int64_t> Access::pairing_step_of(std::string_view given, double utc_s) const {
  const std::string typed = typed_code(given);
  const std::int64_t now = step_at(utc_s);
  std::optional<std::int64_t> found;
  for (std::int64_t step = now - kCodeSteps + 1; step <= now; ++step) {
    if (are_same(typed, code_of(token_, step))) found = step;
  }
  return found;
}

std::string Access::new_session_id() {
  return hexadecimal(random_bytes<kSessionIdCharacters / 2>());
}

std::string Access::session_of(std::string_view id) const {
  return std::string(id) + '.' + hexadecimal(digest_of(token_, "session", id));
}

std::optional<std::string> Access::session_id_of(std::string_view given) const {
  const std::string_view id = given.substr(0, kSessionIdCharacters);
  if (!are_same(given, session_of(id))) return std::nullopt;
  return std::string(id);
}

std::string Access::mark() const {
  const Digest digest = digest_of(token_, "mark", "");
  return hexadecimal(std::span(digest).first<kMarkBytes>());
}

}  // namespace yuragi::daemon::web
