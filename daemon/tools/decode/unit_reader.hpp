#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/text/line_assembler.hpp"

namespace yuragi::daemon::tools::decode {

/// One message of an input, or the text of the input and what is wrong with it.
struct ReadUnit {
  drivers::decode::ByteSpan bytes;
  drivers::decode::ByteSpan request;            ///< the text before '|' in hexadecimal input
  std::string_view text;                        ///< as it is in the input
  std::optional<drivers::decode::Refusal> why;  ///< the reason why nothing can be decoded
  std::string_view detail = {};
};

/// Splits an input, which may arrive in blocks of any size, into messages: lines, as the drivers do (LineAssembler), or
/// one message for each line of hexadecimal digits ("request | response" if there are two). Blank lines of the
/// latter and those that begin with '#' are skipped. Memory is bounded. Thread-safe: no.
class UnitReader {
 public:
  enum class Form : std::uint8_t {
    kLines,
    kHexLines,   ///< lines of text, written in hexadecimal digits
    kHexFrames,  ///< bytes
  };
  using Sink = std::function<void(const ReadUnit&)>;

  /// Lines that are longer than `longest_line` are refused.
  UnitReader(Form form, drivers::decode::text::LineEnding ending,
             std::size_t longest_line = drivers::decode::text::LineAssembler::kMaxLine)
      : form_(form), ending_(ending), longest_line_(longest_line), lines_(ending, longest_line) {}

  /// Takes the next bytes of the input, and calls `sink` with each message that they complete.
  void feed(drivers::decode::ByteSpan bytes, const Sink& sink);
  /// Called at the end of the input, which may be within a line.
  void finish(const Sink& sink);

 private:
  static constexpr std::size_t kMaxHexLine = 8192;

  void take_line(const drivers::decode::text::LineAssembler::Line& line, const Sink& sink);
  void take_hex_line(const Sink& sink);

  Form form_;
  drivers::decode::text::LineEnding ending_;
  std::size_t longest_line_;
  std::size_t longest_hex_line_ = std::max(kMaxHexLine, 3 * longest_line_);  ///< two digits and a blank for a byte
  drivers::decode::text::LineAssembler lines_;
  std::string hex_line_;
  bool is_overlong_ = false;
};

}  // namespace yuragi::daemon::tools::decode
