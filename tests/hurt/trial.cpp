#include "tests/hurt/trial.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace yuragi::hurt {
namespace {

using drivers::decode::checked;

constexpr double kMillion = 1e6;

/// What a wind means for whoever takes it. What is left out is no false value.
enum class Meaning : std::uint8_t { kRight, kOthers, kWrong, kImpossible };

/// Are these values `truth`'s, as far as they are there?
bool is_part_of(const DecodedWind& wind, const DecodedWind& truth) {
  const auto agrees = [](const std::optional<double>& value, const std::optional<double>& true_value) {
    return !value || value == true_value;
  };
  const bool has_frame = !wind.direction_deg || wind.reference == truth.reference;
  return has_frame && agrees(wind.speed_m_s, truth.speed_m_s) && agrees(wind.direction_deg, truth.direction_deg) &&
         agrees(wind.gust_m_s, truth.gust_m_s);
}

Meaning meaning_of(const DecodedWind& wind, const DecodedWind& sent, const DecodedWind& other) {
  if (!checked(wind)) return Meaning::kImpossible;
  if (is_part_of(wind, sent)) return Meaning::kRight;
  return is_part_of(wind, other) ? Meaning::kOthers : Meaning::kWrong;
}

/// Does the checksum find every such damage? By their definitions each finds one bit, and one byte; a CRC of 16 bits
/// with an even number of terms, as all of ours, each odd number of bits and each two bits of messages as short as
/// these, and each burst of up to 16 bits.
bool finds_always(Checksum checksum, const Damage& damage) {
  if (checksum == Checksum::kNone) return false;
  const bool is_in_one_byte =
      damage.count == 1 && (damage.kind == DamageKind::kBits || damage.kind == DamageKind::kBytes);
  if (is_in_one_byte) return true;
  return checksum == Checksum::kCrc16 &&
         (damage.kind == DamageKind::kBurst || (damage.kind == DamageKind::kBits && damage.count <= 3));
}

std::string printable(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    if (c >= ' ' && c <= '~') {
      text += c;
    } else {
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return text;
}

bool is_near(const std::optional<double>& value, const std::optional<double>& made) {
  constexpr double kRounding = 1e-6;
  return value.has_value() == made.has_value() && (!value || std::abs(*value - *made) <= kRounding);
}

/// A whole message, with the very wind that the decoder makes of it.
Message made_by(const Protocol& protocol, Chance& chance) {
  Message message = protocol.make(chance);
  const auto winds = protocol.winds_in(message.bytes);
  const bool is_read = winds.size() == 1 && is_near(winds[0].speed_m_s, message.wind.speed_m_s) &&
                       is_near(winds[0].direction_deg, message.wind.direction_deg) &&
                       is_near(winds[0].gust_m_s, message.wind.gust_m_s);
  if (!is_read) {
    throw std::runtime_error(
        fmt::format("{}: a whole message is not read as it was made: {}", protocol.name, printable(message.bytes)));
  }
  message.wind = winds[0];
  return message;
}

void keep_example(std::vector<std::string>& examples, std::string_view bytes) {
  constexpr std::size_t kMaxExamples = 20;
  if (examples.size() < kMaxExamples) examples.push_back(printable(bytes));
}

}  // namespace

std::int64_t most_false(const Protocol& protocol, std::int64_t messages) {
  const double expected = protocol.most_false_of_a_million * static_cast<double>(messages) / kMillion;
  return static_cast<std::int64_t>(expected + 3.0 * std::sqrt(expected));
}

Tally try_protocol(const Protocol& protocol, std::int64_t messages, std::uint64_t seed) {
  Chance chance(seed);
  Tally tally;
  tally.messages = messages;
  for (std::int64_t i = 0; i < messages; ++i) {
    const Message sent = made_by(protocol, chance);
    const Message other = made_by(protocol, chance);
    const Damage damage = any_damage(chance);
    const std::string bytes = hurt(sent.bytes, other.bytes, damage, chance);
    auto winds = protocol.winds_in(protocol.is_stream ? bytes + other.bytes : bytes);
    // The whole message behind the hurt one is no news.
    if (protocol.is_stream && !winds.empty() && is_part_of(winds.back(), other.wind)) winds.pop_back();

    Meaning worst = Meaning::kRight;
    for (const DecodedWind& wind : winds) worst = std::max(worst, meaning_of(wind, sent.wind, other.wind));
    const bool is_wrong = worst >= Meaning::kWrong;
    if (winds.empty()) ++tally.refused;
    if (!winds.empty() && worst == Meaning::kRight) ++tally.unharmed;
    if (worst == Meaning::kOthers) ++tally.others;
    if (!is_wrong) continue;
    ++tally.wrong;
    keep_example(tally.wrong_examples, bytes);
    if (worst == Meaning::kImpossible) {
      ++tally.impossible;
      keep_example(tally.impossible_examples, bytes);
    }
    if (finds_always(protocol.checksum, damage)) {
      ++tally.found;
      keep_example(tally.found_examples, bytes);
    }
  }
  return tally;
}

std::optional<std::string> verdict(const Protocol& protocol, const Tally& tally) {
  if (tally.impossible > 0) {
    return fmt::format("{}: {} winds that cannot be, such as that of {}", protocol.name, tally.impossible,
                       tally.impossible_examples.front());
  }
  if (tally.found > 0) {
    return fmt::format("{}: {} false winds after damage that its checksum always finds, such as {}", protocol.name,
                       tally.found, tally.found_examples.front());
  }
  if (const std::int64_t most = most_false(protocol, tally.messages); tally.wrong > most) {
    return fmt::format("{}: {} false winds, more than {}, such as that of {}", protocol.name, tally.wrong, most,
                       tally.wrong_examples.front());
  }
  return std::nullopt;
}

}  // namespace yuragi::hurt
