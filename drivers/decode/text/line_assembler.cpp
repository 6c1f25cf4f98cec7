#include "drivers/decode/text/line_assembler.hpp"

namespace yuragi::drivers::decode::text {
namespace {

constexpr std::uint8_t kStartOfText = 0x02;
constexpr std::uint8_t kEndOfText = 0x03;

}  // namespace

std::optional<LineAssembler::Line> LineAssembler::next(std::span<const std::uint8_t>& bytes) noexcept {
  while (!bytes.empty()) {
    const std::uint8_t byte = bytes.front();
    bytes = bytes.subspan(1);

    const bool is_start = byte == kStartOfText;
    const bool is_end = byte == '\r' || byte == '\n' || (byte == kEndOfText && ending_ == LineEnding::kEtx);
    if (is_start) {
      const bool was_cut = size_ > 0;
      clear();
      if (was_cut) return Line(Refusal::kTooShort);
    } else if (is_end) {
      if (auto line = take()) return line;
    } else if (is_skipping_ || (byte == kEndOfText && size_ == 0)) {
      continue;
    } else if (size_ == text_.size()) {
      size_ = 0;
      is_skipping_ = true;
      return Line(Refusal::kMalformed);
    } else {
      text_[size_++] = static_cast<char>(byte);
    }
  }
  return {};
}

std::optional<LineAssembler::Line> LineAssembler::finish() noexcept {
  return take();
}

void LineAssembler::clear() noexcept {
  size_ = 0;
  is_skipping_ = false;
}

std::optional<LineAssembler::Line> LineAssembler::take() noexcept {
  const std::string_view line(text_.data(), size_);
  clear();
  if (line.empty()) return {};
  return Line(line);
}

}  // namespace yuragi::drivers::decode::text
