#include "drivers/decode/lufft/umb.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace yuragi::drivers::decode::lufft {
namespace {

constexpr std::uint8_t kStartOfHeader = 0x01;
constexpr std::uint8_t kStartOfText = 0x02;
constexpr std::uint8_t kEndOfText = 0x03;
constexpr std::uint8_t kEndOfTransmission = 0x04;
constexpr std::uint8_t kVersion = 0x10;
constexpr std::uint8_t kOneChannel = 0x23;
constexpr std::uint8_t kSeveralChannels = 0x2F;
/// Of a frame, in addition to the bytes that its length counts.
constexpr std::size_t kFrameOverhead = 12;
/// The command, its version and the status.
constexpr std::size_t kMinReply = 3;

double signed_8(std::uint8_t byte) {
  return static_cast<std::int8_t>(byte);
}

/// Returns a value of such a type; nullopt if the type is unknown, the size is wrong, or it is not finite.
std::optional<double> value_of(std::uint8_t type, ByteSpan bytes) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  constexpr std::uint8_t kFirst = 0x10;
  if (type < kFirst || type >= kFirst + kSizes.size() || bytes.size() != kSizes[type - kFirst]) return {};
  double value = 0.0;
  switch (type) {
    case 0x10:
      value = bytes[0];
      break;
    case 0x11:
      value = signed_8(bytes[0]);
      break;
    case 0x12:
      value = little_endian_16(bytes, 0);
      break;
    case 0x13:
      value = static_cast<std::int16_t>(little_endian_16(bytes, 0));
      break;
    case 0x14:
      value = little_endian_32(bytes, 0);
      break;
    case 0x15:
      value = static_cast<std::int32_t>(little_endian_32(bytes, 0));
      break;
    case 0x16:
      value = static_cast<double>(std::bit_cast<float>(little_endian_32(bytes, 0)));
      break;
    default:
      value = std::bit_cast<double>(little_endian_32(bytes, 0) |
                                    (static_cast<std::uint64_t>(little_endian_32(bytes, 4)) << 32U));
  }
  if (!std::isfinite(value)) return {};
  return value;
}

/// A status, a channel, and, if the status is good, the type and the value.
std::optional<UmbChannel> channel_of(std::uint8_t status, ByteSpan bytes) {
  if (bytes.size() < 2) return {};
  UmbChannel channel{.channel = little_endian_16(bytes, 0), .status = status, .value = {}};
  if (status != 0) return channel;
  if (bytes.size() < 3) return {};
  channel.value = value_of(bytes[2], bytes.subspan(3));
  return channel;
}

/// The part after the status of a reply to 2Fh.
std::optional<Refusal> read_channels(ByteSpan bytes, UmbReply& reply) {
  if (bytes.empty()) return Refusal::kMalformed;
  const std::size_t count = bytes[0];
  bytes = bytes.subspan(1);
  if (count > kMaxUmbChannels) return Refusal::kMalformed;
  for (; reply.count < count; ++reply.count) {
    if (bytes.empty() || bytes[0] == 0 || bytes.size() <= bytes[0]) return Refusal::kMalformed;
    const auto channel = channel_of(bytes[1], bytes.subspan(2, bytes[0] - 1U));
    if (!channel) return Refusal::kMalformed;
    reply.channels[reply.count] = *channel;
    bytes = bytes.subspan(bytes[0] + 1U);
  }
  if (!bytes.empty()) return Refusal::kMalformed;
  return {};
}

std::optional<Refusal> frame_refusal(ByteSpan frame) {
  if (!begins_umb_frame(frame)) return Refusal::kMalformed;
  if (frame.size() < kFrameOverhead + kMinReply - 1) return Refusal::kTooShort;
  const std::size_t size = umb_frame_size(frame);
  if (frame.size() < size) return Refusal::kTooShort;
  if (frame.size() > size || frame[size - 4] != kEndOfText || frame[size - 1] != kEndOfTransmission)
    return Refusal::kMalformed;
  if (umb_checksum(frame.first(size - 3)) != little_endian_16(frame, size - 3)) return Refusal::kBadChecksum;
  return {};
}

std::optional<double> value_in(const UmbReply& reply, std::uint16_t channel) {
  const UmbChannel* const found = reply.find(channel);
  return found == nullptr ? std::nullopt : found->value;
}

std::optional<double> first_value_in(const UmbReply& reply, std::uint16_t channel, std::uint16_t other) {
  const auto value = value_in(reply, channel);
  return value ? value : value_in(reply, other);
}

}  // namespace

std::uint16_t umb_checksum(ByteSpan bytes) noexcept {
  constexpr unsigned kPolynomialReversed = 0x8408;
  unsigned sum = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    sum ^= byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? kPolynomialReversed : 0U);
  }
  return static_cast<std::uint16_t>(sum);
}

bool begins_umb_frame(ByteSpan beginning) noexcept {
  const auto has = [&](std::size_t at, auto holds) { return beginning.size() <= at || holds(beginning[at]); };
  return has(0, [](std::uint8_t byte) { return byte == kStartOfHeader; }) &&
         has(1, [](std::uint8_t byte) { return byte == kVersion; }) &&
         has(6, [](std::uint8_t byte) { return byte >= 2 && byte + kFrameOverhead <= kMaxUmbFrame; }) &&
         has(7, [](std::uint8_t byte) { return byte == kStartOfText; });
}

std::size_t umb_frame_size(ByteSpan beginning) noexcept {
  return beginning[6] + kFrameOverhead;
}

std::vector<std::uint8_t> umb_request(std::uint16_t address, std::span<const std::uint16_t> channels) {
  std::vector<std::uint8_t> frame = {kStartOfHeader, kVersion};
  const auto put_16 = [&frame](std::uint16_t value) {
    frame.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    frame.push_back(static_cast<std::uint8_t>(value >> 8U));
  };
  put_16(address);
  put_16(kUmbController);
  frame.push_back(static_cast<std::uint8_t>(kMinReply + 2 * channels.size()));
  frame.insert(frame.end(), {kStartOfText, kSeveralChannels, kVersion, static_cast<std::uint8_t>(channels.size())});
  for (const std::uint16_t channel : channels) put_16(channel);
  frame.push_back(kEndOfText);
  put_16(umb_checksum(frame));
  frame.push_back(kEndOfTransmission);
  return frame;
}

const UmbChannel* UmbReply::find(std::uint16_t channel) const noexcept {
  const auto* const end = channels.begin() + count;
  const auto* const found =
      std::find_if(channels.begin(), end, [channel](const UmbChannel& each) { return each.channel == channel; });
  return found == end ? nullptr : found;
}

Result<UmbReply, Refusal> decode_umb_reply(std::optional<std::uint16_t> address, ByteSpan frame) noexcept {
  if (const auto refusal = frame_refusal(frame)) return *refusal;
  UmbReply reply;
  reply.address = little_endian_16(frame, 4);
  const std::uint8_t command = frame[8];
  const bool is_reply = is_umb_controller(little_endian_16(frame, 2)) && !is_umb_controller(reply.address) &&
                        (command == kOneChannel || command == kSeveralChannels);
  if (!is_reply || (address && reply.address != *address)) return Refusal::kNotMine;
  if (frame[6] < kMinReply) return Refusal::kMalformed;
  const std::uint8_t status = frame[10];
  if (status != 0) return Refusal::kException;

  const ByteSpan said = frame.subspan(11, frame[6] - kMinReply);
  if (command == kSeveralChannels) {
    if (const auto refusal = read_channels(said, reply)) return *refusal;
    return reply;
  }
  const auto channel = channel_of(status, said);
  if (!channel) return Refusal::kMalformed;
  reply.channels[reply.count++] = *channel;
  return reply;
}

Result<DecodedWind, Refusal> wind_of(const UmbReply& reply) noexcept {
  DecodedWind wind;
  wind.speed_m_s = first_value_in(reply, umb_channel::kFastSpeed, umb_channel::kSpeed);
  wind.gust_m_s = value_in(reply, umb_channel::kMaxSpeed);
  if (wind.gust_m_s && wind.speed_m_s && *wind.gust_m_s < *wind.speed_m_s) wind.gust_m_s.reset();
  if (const auto direction_deg = first_value_in(reply, umb_channel::kFastDirection, umb_channel::kDirection)) {
    wind.direction_deg = wrapped_direction_deg(*direction_deg);
    if (!wind.direction_deg) wind.status = DecodedStatus::kUncertain;
  }
  return checked(wind);
}

wind::StationQuantities quantities_of(const UmbReply& reply) noexcept {
  wind::StationQuantities quantities;
  quantities.air_temperature_c = value_in(reply, umb_channel::kAirTemperature);
  quantities.pressure_hpa = value_in(reply, umb_channel::kPressure);
  quantities.relative_humidity_percent = value_in(reply, umb_channel::kRelativeHumidity);
  quantities.rain_total_mm = value_in(reply, umb_channel::kRainTotal);
  quantities.rain_rate_mm_h = value_in(reply, umb_channel::kRainRate);
  return quantities;
}

}  // namespace yuragi::drivers::decode::lufft
