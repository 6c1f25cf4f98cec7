#include "drivers/decode/marine/candump.hpp"

#include <algorithm>

#include "drivers/decode/marine/bus_frame.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

constexpr std::size_t kStandardDigits = 3;
constexpr std::size_t kExtendedDigits = 8;

// Of an error frame: linux/can/error.h.
constexpr std::uint32_t kErrorFlag = 0x20000000;
constexpr std::uint32_t kControllerProblem = 0x004;
constexpr std::uint32_t kBusOff = 0x040;
constexpr std::uint32_t kRestarted = 0x100;
constexpr unsigned kAnyWarning = 0x0C;
constexpr unsigned kAnyPassive = 0x30;
constexpr unsigned kActiveAgain = 0x40;

/// The next word, which is taken off the text; empty at its end.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(" \t"));
  text.remove_prefix(word.size());
  return word;
}

/// The text after the interface's name.
std::string_view after_interface(std::string_view line) {
  std::string_view rest = trimmed(line);
  if (rest.starts_with('(')) take_word(rest);
  take_word(rest);
  return trimmed(rest);
}

/// Two digits a byte.
bool take_byte(BusFrame& frame, std::string_view digits) {
  const auto byte = hex_number(digits, 2);
  if (!byte || frame.size == frame.data.size()) return false;
  frame.data[frame.size++] = static_cast<std::uint8_t>(*byte);
  return true;
}

/// "641E01C8F1FAFFFF"
Result<BusFrame, Refusal> with_digits(BusFrame frame, std::string_view digits) {
  if (digits.starts_with('#') || digits.starts_with('R')) return Refusal::kNotMine;
  if (digits.size() % 2 != 0) return Refusal::kMalformed;
  for (; !digits.empty(); digits.remove_prefix(2)) {
    if (!take_byte(frame, digits.substr(0, 2))) return Refusal::kMalformed;
  }
  return frame;
}

/// "[8] 64 1E 01 C8 F1 FA FF FF", and possibly: the same as text, in quotes, or "ERRORFRAME".
Result<BusFrame, Refusal> with_words(BusFrame frame, std::string_view words) {
  const std::string_view count = take_word(words);
  if (count.size() == 4) return Refusal::kNotMine;  // [08]: CAN FD
  if (count.size() != 3 || count.front() != '[' || count.back() != ']') return Refusal::kMalformed;
  const auto size = hex_number(count.substr(1, 1), 1);
  if (!size || *size > frame.data.size()) return Refusal::kMalformed;
  if (trimmed(words).starts_with("remote")) return Refusal::kNotMine;
  while (frame.size < *size) {
    const std::string_view word = take_word(words);
    if (word.empty()) return Refusal::kTooShort;
    if (!take_byte(frame, word)) return Refusal::kMalformed;
  }
  const std::string_view rest = trimmed(words);
  const bool is_over = rest.empty() || rest.starts_with('\'') || rest == "ERRORFRAME";
  return is_over ? Result<BusFrame, Refusal>(frame) : Refusal::kMalformed;
}

/// The frame in a line, of the bus or of its controller.
Result<BusFrame, Refusal> frame_in(std::string_view line) {
  std::string_view rest = after_interface(line);
  std::string_view identifier = take_word(rest);
  const std::size_t mark = identifier.find('#');
  const bool is_compact = mark != std::string_view::npos;
  if (identifier.empty() || (!is_compact && trimmed(rest).empty())) return Refusal::kTooShort;
  const std::string_view digits = is_compact ? identifier.substr(mark + 1) : std::string_view();
  identifier = identifier.substr(0, mark);
  if (hex_number(identifier, kStandardDigits)) return Refusal::kNotMine;
  const auto number = hex_number(identifier, kExtendedDigits);
  if (!number || *number >= 2 * kErrorFlag) return Refusal::kMalformed;
  const BusFrame frame = {.identifier = *number};
  return is_compact ? with_digits(frame, digits) : with_words(frame, rest);
}

bool is_of_controller(const BusFrame& frame) {
  return (frame.identifier & kErrorFlag) != 0;
}

}  // namespace

bool looks_like_candump(std::string_view line) noexcept {
  std::string_view rest = after_interface(line);
  const std::string_view identifier = take_word(rest);
  return identifier.find('#') != std::string_view::npos || trimmed(rest).starts_with('[');
}

std::optional<ControllerState> candump_controller_state(std::string_view line) noexcept {
  const auto frame = frame_in(line);
  if (!frame || !is_of_controller(*frame)) return {};
  if ((frame->identifier & kBusOff) != 0) return ControllerState::kBusOff;
  if ((frame->identifier & kRestarted) != 0) return ControllerState::kGood;
  if ((frame->identifier & kControllerProblem) == 0) return {};
  const unsigned problem = frame->data[1];
  if ((problem & kAnyPassive) != 0) return ControllerState::kPassive;
  if ((problem & (kAnyWarning | kActiveAgain)) != 0) return ControllerState::kGood;
  return {};
}

Result<BusWind, Refusal> decode_candump(std::string_view line) noexcept {
  const auto frame = frame_in(line);
  if (!frame) return frame.error();
  if (is_of_controller(*frame)) return Refusal::kException;
  return decode_bus_frame(*frame);
}

}  // namespace yuragi::drivers::decode::marine
