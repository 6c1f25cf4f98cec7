#include "drivers/hid/hid_exchange.hpp"

#include <algorithm>

namespace yuragi::drivers::hid {
namespace {

// More than the kernel keeps for a reader (64), so that a device that never stops sending cannot block this.
constexpr int kMaxWaiting = 128;

}  // namespace

Message Exchange::read(Nanoseconds timeout) {
  const bus::HidArrival arrival = device_.read(std::span(buffer_).first(kMaxReport), timeout);
  if (arrival.status != bus::HidStatus::kReport) return {arrival.status, {}};
  const decode::ByteSpan bytes = decode::ByteSpan(buffer_).first(arrival.size);
  sink_.raw(sensor::RawDirection::kReceived, bytes);
  return {arrival.status, bytes};
}

bool Exchange::send(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMaxReport) return false;
  std::array<std::uint8_t, kMaxReport + 1> numbered{};
  std::ranges::copy(bytes, numbered.begin() + 1);
  sink_.raw(sensor::RawDirection::kSent, bytes);
  return device_.write(std::span(numbered).first(bytes.size() + 1));
}

Message Exchange::get_input_report(std::uint8_t id, std::size_t size) {
  const bus::HidArrival arrival = device_.get_input_report(id, std::span(buffer_).first(std::min(size, kMaxReport)));
  if (arrival.status != bus::HidStatus::kReport) return {arrival.status, {}};
  const decode::ByteSpan bytes = decode::ByteSpan(buffer_).first(arrival.size);
  sink_.raw(sensor::RawDirection::kReceived, bytes);
  return {arrival.status, bytes};
}

bool Exchange::discard_waiting() {
  for (int i = 0; i < kMaxWaiting; ++i) {
    const Message message = read(Nanoseconds::zero());
    if (message.status != bus::HidStatus::kReport) return message.status != bus::HidStatus::kLost;
    refuse(decode::Refusal::kNotMine);
  }
  return true;
}

void Exchange::publish(std::optional<wind::StationQuantities> quantities) {
  if (!quantities) return;
  quantities->time = clock_.now();
  sink_.quantities(*quantities);
}

bool Exchange::publish(const decode::DecodedWind& wind) {
  if (!wind.speed_m_s) {
    refuse(decode::Refusal::kInvalid);
    return false;
  }
  const bool is_good = wind.status == decode::DecodedStatus::kGood;
  sink_.reading({.time = clock_.now(),
                 .speed_m_s = *wind.speed_m_s,
                 .direction_deg = wind.direction_deg,
                 .gust_m_s = wind.gust_m_s,
                 .quality = is_good ? wind::ReadingQuality::kGood : wind::ReadingQuality::kUncertain});
  return true;
}

}  // namespace yuragi::drivers::hid
