#include "daemon/tools/decode/unit_reader.hpp"

#include "daemon/tools/decode/hex_text.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

drivers::decode::ByteSpan bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

void UnitReader::feed(drivers::decode::ByteSpan bytes, const Sink& sink) {
  if (form_ == Form::kLines) {
    while (!bytes.empty()) {
      if (const auto line = lines_.next(bytes)) take_line(*line, sink);
    }
    return;
  }
  for (const std::uint8_t byte : bytes) {
    if (byte == '\n') {
      take_hex_line(sink);
    } else if (hex_line_.size() < longest_hex_line_) {
      hex_line_ += static_cast<char>(byte);
    } else {
      is_overlong_ = true;
    }
  }
}

void UnitReader::finish(const Sink& sink) {
  if (form_ != Form::kLines) return take_hex_line(sink);
  if (const auto line = lines_.finish()) take_line(*line, sink);
}

void UnitReader::take_line(const drivers::decode::text::LineAssembler::Line& line, const Sink& sink) {
  if (line) return sink({.bytes = bytes_of(*line), .request = {}, .text = *line, .why = {}});
  const bool is_cut = line.error() == drivers::decode::Refusal::kTooShort;
  sink({.bytes = {},
        .request = {},
        .text = {},
        .why = line.error(),
        .detail = is_cut ? "cut off by the beginning of the next message" : "line too long"});
}

void UnitReader::take_hex_line(const Sink& sink) {
  std::string_view text = drivers::decode::trimmed(hex_line_);
  const auto refuse = [&](std::string_view detail) {
    sink({.bytes = {}, .request = {}, .text = text, .why = drivers::decode::Refusal::kMalformed, .detail = detail});
  };
  if (is_overlong_) {
    refuse("line too long");
  } else if (!text.empty() && text.front() != '#') {
    // "request | response", or one message alone.
    const auto bar = text.find('|');
    const auto request = parse_hex(bar == std::string_view::npos ? std::string_view() : text.substr(0, bar));
    const auto bytes = parse_hex(bar == std::string_view::npos ? text : text.substr(bar + 1));
    if (!request || !bytes) {
      refuse("not hexadecimal digits, two per byte");
    } else if (form_ == Form::kHexFrames) {
      sink({.bytes = *bytes, .request = *request, .text = text, .why = {}});
    } else {
      // Lines of text end at their line ends, or with the message.
      UnitReader lines(Form::kLines, ending_, longest_line_);
      const auto with_digits = [&](ReadUnit unit) {
        unit.text = text;
        sink(unit);
      };
      lines.feed(*bytes, with_digits);
      lines.finish(with_digits);
    }
  }
  hex_line_.clear();
  is_overlong_ = false;
}

}  // namespace yuragi::daemon::tools::decode
