#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/decode/byte_order.hpp"
#include "drivers/decode/text/line_assembler.hpp"

namespace yuragi {

/// One message of an input, or why there is none: the input itself, as text, and what is wrong with it.
struct ReadUnit {
  ByteSpan bytes;
  ByteSpan request;            ///< what stands before '|' in hexadecimal input
  std::string_view text;       ///< what stood in the input
  std::optional<Refusal> why;  ///< nothing can be decoded
  std::string_view detail = {};
};

/// Cuts an input into messages, however its bytes come: into lines, as the drivers do it (LineAssembler), or a message
/// from each line of hexadecimal digits, "request | response" where there are two. There, blank lines and lines that
/// begin with '#' are passed over. Memory is bounded. Thread-safe: no.
class UnitReader {
 public:
  enum class Form : std::uint8_t {
    kLines,
    kHexLines,   ///< lines of text, written in hexadecimal digits
    kHexFrames,  ///< bytes
  };
  using Sink = std::function<void(const ReadUnit&)>;

  UnitReader(Form form, LineEnding ending) : form_(form), ending_(ending), lines_(ending) {}

  /// Takes the next bytes of the input and tells `sink` of each message that they end.
  void feed(ByteSpan bytes, const Sink& sink);
  /// The input ends here, within a line perhaps.
  void finish(const Sink& sink);

 private:
  static constexpr std::size_t kMaxHexLine = 8192;

  void take_line(const LineAssembler::Line& line, const Sink& sink);
  void take_hex_line(const Sink& sink);

  Form form_;
  LineEnding ending_;
  LineAssembler lines_;
  std::string hex_line_;
  bool is_overlong_ = false;
};

}  // namespace yuragi
