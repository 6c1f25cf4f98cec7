// liblo 0.31 takes messages apart; its server is of no use here. It would keep the messages of bundles that are meant
// for later, without a limit, and follow nested bundles without a limit.
#include "drivers/bus/osc_message.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include <lo/lo.h>

namespace yuragi::drivers::bus {
namespace {

using OscBytes = std::span<const std::uint8_t>;

/// "#bundle", a time of 8 bytes, and then elements: their size in 4 bytes, and that many of a message or a bundle.
constexpr std::array<std::uint8_t, 8> kBundleMark = {'#', 'b', 'u', 'n', 'd', 'l', 'e', 0};
constexpr std::size_t kTimeTag = 8;
constexpr std::size_t kBundleHead = kBundleMark.size() + kTimeTag;
constexpr std::size_t kElementHead = 4;
/// A time tag for "at once".
constexpr std::uint64_t kAtOnce = 1;
constexpr std::int64_t kFrom1900To1970_s = 2'208'988'800;
constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;
/// The deepest nesting of bundles that is accepted.
constexpr int kDeepestBundle = 8;

struct FreeOscMessage {
  void operator()(lo_message message) const noexcept { lo_message_free(message); }
};
using LibloMessage = std::unique_ptr<std::remove_pointer_t<lo_message>, FreeOscMessage>;

/// liblo returns pointers into the datagram, which may be misaligned for a number of 8 bytes.
template <class Number>
double osc_number_at(const void* argument) {
  Number number{};
  std::memcpy(&number, argument, sizeof number);
  return static_cast<double>(number);
}

std::optional<double> osc_number(char type, const void* argument) {
  double number = 0.0;
  switch (type) {
    case LO_INT32:
      number = osc_number_at<std::int32_t>(argument);
      break;
    case LO_INT64:
      number = osc_number_at<std::int64_t>(argument);
      break;
    case LO_FLOAT:
      number = osc_number_at<float>(argument);
      break;
    case LO_DOUBLE:
      number = osc_number_at<double>(argument);
      break;
    default:
      return std::nullopt;
  }
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

/// Of 8 bytes: seconds, and a fraction of one, as NTP counts them.
std::optional<UtcTime> osc_time(OscBytes tag) {
  constexpr std::int64_t kFrom1900To2036_s = std::int64_t{1} << 32U;
  std::uint64_t number = 0;
  for (const std::uint8_t byte : tag) number = number << 8U | byte;
  if (number <= kAtOnce) return std::nullopt;
  const auto counted_s = static_cast<std::int64_t>(number >> 32U);
  const bool is_before_2036 = number >> 63U != 0;
  const std::int64_t since_1970_s = counted_s - kFrom1900To1970_s + (is_before_2036 ? 0 : kFrom1900To2036_s);
  const std::uint64_t fraction_ns = ((number & 0xffff'ffffU) * kNanosecondsPerSecond) >> 32U;
  return UtcTime(std::chrono::seconds(since_1970_s) + Nanoseconds(static_cast<std::int64_t>(fraction_ns)));
}

/// The reverse; the seconds wrap in 2036.
std::uint64_t osc_tag(UtcTime time) {
  const auto since_1970 = time.time_since_epoch();
  const auto whole = std::chrono::floor<std::chrono::seconds>(since_1970);
  const auto fraction_ns = static_cast<std::uint64_t>(Nanoseconds(since_1970 - whole).count());
  const auto counted_s = static_cast<std::uint64_t>(whole.count() + kFrom1900To1970_s) & 0xffff'ffffU;
  return counted_s << 32U | (fraction_ns << 32U) / kNanosecondsPerSecond;
}

void append_big_endian(std::vector<std::uint8_t>& bytes, std::uint64_t number, std::size_t count) {
  while (count-- > 0) bytes.push_back(static_cast<std::uint8_t>(number >> 8U * count));
}

std::vector<std::uint8_t> serialised(const LibloMessage& message, const std::string& address) {
  std::vector<std::uint8_t> bytes(lo_message_length(message.get(), address.c_str()));
  std::size_t size = bytes.size();
  lo_message_serialise(message.get(), address.c_str(), bytes.data(), &size);
  return bytes;
}

LibloMessage new_message() {
  LibloMessage message(lo_message_new());
  if (!message) throw std::bad_alloc();
  return message;
}

/// Appends the message. Returns false if it is invalid.
bool take_message(OscBytes bytes, std::optional<UtcTime> meant_for, std::vector<OscMessage>& messages) {
  // liblo converts the byte order in place.
  std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  const LibloMessage message(lo_message_deserialise(copy.data(), copy.size(), nullptr));
  if (!message) return false;
  OscMessage& taken = messages.emplace_back();
  taken.meant_for = meant_for;
  taken.address.assign(copy.begin(), std::ranges::find(copy, std::uint8_t{0}));
  const char* const types = lo_message_get_types(message.get());
  lo_arg** const arguments = lo_message_get_argv(message.get());
  for (int i = 0; i < lo_message_get_argc(message.get()); ++i)
    taken.numbers.push_back(osc_number(types[i], arguments[i]));
  return true;
}

/// Appends the content: a message, or a bundle `depth` bundles deep, in bundles for `meant_for`. Returns false if any
/// part is neither.
bool take_element(OscBytes bytes, int depth, std::optional<UtcTime> meant_for, std::vector<OscMessage>& messages) {
  const bool is_bundle =
      bytes.size() >= kBundleMark.size() && std::equal(kBundleMark.begin(), kBundleMark.end(), bytes.begin());
  if (!is_bundle) return !bytes.empty() && take_message(bytes, meant_for, messages);
  if (bytes.size() < kBundleHead || depth >= kDeepestBundle) return false;
  meant_for = std::max(meant_for, osc_time(bytes.subspan(kBundleMark.size(), kTimeTag)));
  bytes = bytes.subspan(kBundleHead);
  while (!bytes.empty()) {
    if (bytes.size() < kElementHead) return false;
    const std::size_t size =
        std::size_t{bytes[0]} << 24U | std::size_t{bytes[1]} << 16U | std::size_t{bytes[2]} << 8U | bytes[3];
    bytes = bytes.subspan(kElementHead);
    if (size > bytes.size() || !take_element(bytes.first(size), depth + 1, meant_for, messages)) return false;
    bytes = bytes.subspan(size);
  }
  return true;
}

}  // namespace

Result<std::vector<OscMessage>, decode::Refusal> decode_osc(OscBytes datagram) {
  if (datagram.empty()) return decode::Refusal::kTooShort;
  std::vector<OscMessage> messages;
  if (!take_element(datagram, 0, std::nullopt, messages)) return decode::Refusal::kMalformed;
  return messages;
}

std::vector<std::uint8_t> encode_osc(const std::string& address, std::span<const float> numbers) {
  const LibloMessage message = new_message();
  for (const float number : numbers) lo_message_add_float(message.get(), number);
  return serialised(message, address);
}

std::vector<std::uint8_t> encode_osc(const std::string& address, const std::string& text) {
  const LibloMessage message = new_message();
  lo_message_add_string(message.get(), text.c_str());
  return serialised(message, address);
}

std::vector<std::uint8_t> encode_osc_bundle(std::span<const std::vector<std::uint8_t>> messages,
                                            std::optional<UtcTime> meant_for) {
  std::vector<std::uint8_t> bundle(kBundleMark.begin(), kBundleMark.end());
  append_big_endian(bundle, meant_for ? osc_tag(*meant_for) : kAtOnce, kTimeTag);
  for (const std::vector<std::uint8_t>& message : messages) {
    append_big_endian(bundle, message.size(), kElementHead);
    bundle.insert(bundle.end(), message.begin(), message.end());
  }
  return bundle;
}

bool osc_address_matches(const std::string& address, const std::string& pattern) {
  return lo_pattern_match(address.c_str(), pattern.c_str()) != 0;
}

}  // namespace yuragi::drivers::bus
