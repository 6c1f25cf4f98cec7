#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::text {

/// Where a line ends.
enum class LineEnding : std::uint8_t {
  kNewline,  ///< at CR, LF or both; an ETX within belongs to the line (Gill has its checksum behind it)
  kEtx,      ///< at ETX too
};

/// Makes lines of bytes, however these were split on their way. Bounded: a line longer than `longest` is refused once
/// and skipped up to its end. STX begins a line anew; empty lines, and an ETX at the beginning of one, are skipped.
/// All other bytes are kept.
///
///     while (!bytes.empty()) {
///       if (const auto line = assembler.next(bytes)) use(*line);
///     }
///
/// Not thread-safe; realtime-safe: allocates when it is made, and never again.
class LineAssembler {
 public:
  /// The longest line of an anemometer without its end: NMEA allows 80, and 129 are seen.
  static constexpr std::size_t kMaxLine = 512;

  using Line = Result<std::string_view, Refusal>;

  explicit LineAssembler(LineEnding ending = LineEnding::kNewline, std::size_t longest = kMaxLine)
      : text_(longest), ending_(ending) {}

  /// Takes bytes from the front of `bytes` until a line is whole or they are used up. The view is valid until the next
  /// call. Refusals: kMalformed (longer than the longest), kTooShort (cut off by the STX of the next one).
  std::optional<Line> next(std::span<const std::uint8_t>& bytes) noexcept;

  /// Returns the bytes since the last line end: the last line of a file or datagram. Clears them.
  std::optional<Line> finish() noexcept;

  /// Drops the bytes received so far, after a connection was lost.
  void clear() noexcept;

 private:
  std::optional<Line> take() noexcept;

  std::vector<char> text_;  // of the longest line's size
  std::size_t size_ = 0;
  bool is_skipping_ = false;  // an overlong line was refused, and has not ended
  LineEnding ending_;
};

}  // namespace yuragi::drivers::decode::text
