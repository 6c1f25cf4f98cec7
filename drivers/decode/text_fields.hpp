#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode {

// The common part of the decoders of lines: fields, numbers, checksums, units. Nothing here allocates, throws or keeps
// state; views point into the line that was given. Thread-safe and realtime-safe: yes.

/// The treatment of a line without a checksum or status that its format requires.
enum class WhenMissing : std::uint8_t { kRefuse, kAccept };

/// More fields than any sentence has; a line with more is refused.
inline constexpr std::size_t kMaxTextFields = 96;

/// The fields of one line.
struct TextFields {
  std::array<std::string_view, kMaxTextFields> values{};
  std::size_t count = 0;
  bool are_all = true;  ///< false if the line has more than kMaxTextFields

  /// A field without the blanks around it; empty if the line has ended already.
  std::string_view operator[](std::size_t i) const noexcept { return i < count ? values[i] : std::string_view(); }
};

TextFields split_fields(std::string_view text, char separator) noexcept;

/// Without the blanks, tabs, line ends and NUL bytes at both ends.
std::string_view trimmed(std::string_view text) noexcept;

/// A decimal number as devices print them ("046.", "+3.4", ".5"): nullopt for an empty field, kMalformed for anything
/// else (exponents, hexadecimal numbers, "nan", two numbers).
Result<std::optional<double>, Refusal> parse_number(std::string_view field) noexcept;

/// The same for a direction in degrees, brought into [0, 360); kImplausible for one that is no direction.
Result<std::optional<double>, Refusal> parse_direction_deg(std::string_view field) noexcept;

/// The exclusive or of all bytes: the checksum of NMEA 0183, Gill and FT Technologies.
std::uint8_t xor_checksum(std::string_view text) noexcept;

/// Is `digits` that checksum of `text`? Two hexadecimal digits, of either case: kTooShort if there are fewer,
/// kMalformed if there is more.
std::optional<Refusal> xor_checksum_refusal(std::string_view text, std::string_view digits) noexcept;

/// What stands between '$' and '*' in a line with a sentence. What comes before the last '$' is skipped (NUL bytes, a
/// time stamp, a sentence that was cut off); a line that begins with '#' holds none. Refusals, in this order: kTooShort
/// (an empty line), kNotMine (no '$'), kTooShort (it ends within its checksum), kBadChecksum (wrong, or missing where
/// that is refused; "//" is a checksum that was switched off, and counts as missing).
Result<std::string_view, Refusal> sentence_of(std::string_view line, WhenMissing checksum) noexcept;

/// The factor to m/s of an anemometer's unit letter: M (m/s), N (knots), K (km/h), which all of them use.
std::optional<double> metres_per_second_of(std::string_view letter) noexcept;

/// Returns true for a good status: A (NMEA), 00 and 60 (Gill).
bool is_good_status(std::string_view status) noexcept;

}  // namespace yuragi::drivers::decode
