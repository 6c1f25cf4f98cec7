#include "drivers/decode/marine/actisense.hpp"

#include <array>

#include "drivers/decode/marine/bus_frame.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

constexpr std::string_view kActisenseTimeShape = "A000000.000";
constexpr std::size_t kActisenseDigits = 5;  // of addresses and priority, and of the PGN
constexpr std::uint32_t kMaxActisensePriority = 7;

bool begins_with_actisense_time(std::string_view line) {
  if (line.size() < kActisenseTimeShape.size()) return false;
  for (std::size_t i = 0; i < kActisenseTimeShape.size(); ++i) {
    const bool is_digit = line[i] >= '0' && line[i] <= '9';
    if (kActisenseTimeShape[i] == '0' ? !is_digit : line[i] != kActisenseTimeShape[i]) return false;
  }
  return true;
}

/// Removes the next word from the front; empty if there are no more.
std::string_view take_actisense_word(std::string_view& rest) {
  rest = trimmed(rest);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
  rest.remove_prefix(word.size());
  return word;
}

}  // namespace

bool looks_like_actisense(std::string_view line) noexcept {
  return begins_with_actisense_time(trimmed(line));
}

std::string_view actisense_time(std::string_view line) noexcept {
  line = trimmed(line);
  const std::string_view time = take_actisense_word(line);
  const bool is_time = time.size() == kActisenseTimeShape.size() && begins_with_actisense_time(time);
  return is_time ? time.substr(1) : std::string_view();
}

Result<BusWind, Refusal> decode_actisense(std::string_view line) noexcept {
  std::string_view rest = line;
  const std::string_view time = take_actisense_word(rest);
  const std::string_view way = take_actisense_word(rest);
  const std::string_view pgn_digits = take_actisense_word(rest);
  rest = trimmed(rest);
  if (rest.empty()) return Refusal::kTooShort;
  const auto addresses_and_priority = hex_number(way, kActisenseDigits);
  const auto pgn = hex_number(pgn_digits, kActisenseDigits);
  if (actisense_time(time).empty() || !addresses_and_priority || !pgn ||
      (*addresses_and_priority & 0xFU) > kMaxActisensePriority) {
    return Refusal::kMalformed;
  }
  if (*pgn != kWindDataPgn) return Refusal::kNotMine;

  std::array<std::uint8_t, 8> data{};
  std::size_t size = 0;
  for (; !rest.empty(); rest = trimmed(rest.substr(2))) {
    const auto byte = hex_number(rest.substr(0, 2), 2);
    if (!byte || size == data.size()) return Refusal::kMalformed;
    data[size++] = static_cast<std::uint8_t>(*byte);
  }
  return decode_wind_data(static_cast<std::uint8_t>(*addresses_and_priority >> 12U), ByteSpan(data).first(size));
}

}  // namespace yuragi::drivers::decode::marine
