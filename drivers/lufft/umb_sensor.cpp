#include "drivers/lufft/umb_sensor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace yuragi::drivers::lufft {
namespace {

using namespace std::chrono_literals;
using decode::Refusal;

/// A read returns at least this often, so that timeouts are checked.
constexpr Nanoseconds kMaxRead = 200ms;
/// A reply that is later than this is not expected any more.
constexpr Nanoseconds kLatestReply = 2s;
/// After this many requests without a reply the port is reopened.
constexpr int kVainRequests = 4;
/// Without a reading for this time, or for this many intervals, something is wrong.
constexpr Nanoseconds kPatience = 3s;
constexpr int kPatientIntervals = 3;
constexpr int kForgottenBlocks = 16;

/// Why a device has no wind, by the status of its speed.
std::string trouble_of_status(std::uint8_t status) {
  switch (status) {
    case 0x24:
      return "it measures no wind, or not on these channels";
    case 0x28:
      return "it is not ready yet";
    case 0x55:
      return "the weather prevents it: check for ice, dirt and birds";
    default:
      return "check the device";
  }
}

}  // namespace

UmbSensor::UmbSensor(const UmbSettings& settings, std::unique_ptr<bus::BytePort> port)
    : sensor::ReopeningSensor(sensor::seed_of(describe(settings.address))),
      settings_(settings),
      name_(fmt::format("Lufft {:04X}h", settings.device)),
      where_(describe(settings.address)),
      port_(std::move(port)) {
  settings_.response_timeout = std::min(settings_.response_timeout, settings_.poll_interval);
}

Result<MonoTime, Failure> UmbSensor::open(const sensor::Clock& clock) {
  if (const auto opened = port_->open(); !opened) return opened.error();
  const MonoTime now = clock.now().mono;
  asks_for_all_ = true;
  awaits_reply_ = false;
  next_request_ = std::max(now, next_request_);  // a late reply may still be on its way
  last_reading_ = now;
  vain_requests_ = 0;
  trouble_.clear();
  return next_request_;
}

Result<MonoTime, Failure> UmbSensor::work(const sensor::Clock& clock, sensor::Sink& sink) {
  const MonoTime start = clock.now().mono;
  if (!awaits_reply_) {
    if (start < next_request_) return next_request_;
    if (!ask(start, sink)) return Failure{where_ + " does not accept requests: reopening it"};
  }
  const bus::ByteArrival arrival = port_->read(buffer_, std::clamp<Nanoseconds>(reply_due_ - start, 0ns, kMaxRead));
  const Instant now = clock.now();
  switch (arrival.status) {
    case bus::ByteStatus::kInterrupted:
      return now.mono;
    case bus::ByteStatus::kLost:
    case bus::ByteStatus::kEnd:
      return Failure{where_ + " is gone: it is reopened when it is back; check its plug, its power and the network"};
    case bus::ByteStatus::kBytes:
      take(decode::ByteSpan(buffer_).first(arrival.size), now, sink);
      break;
    case bus::ByteStatus::kForeign:
    case bus::ByteStatus::kSilence:
      break;
  }
  // Only after all that has been received.
  if (awaits_reply_ && now.mono >= reply_due_) {
    if (const auto given_up = give_up_reply(now.mono, sink); !given_up) return given_up.error();
  }
  const Nanoseconds patience = std::max<Nanoseconds>(kPatience, kPatientIntervals * settings_.poll_interval);
  if (!trouble_.empty() && now.mono - last_reading_ >= patience) {
    is_there_ ? report_connected(sink, trouble_) : report_unusable(sink, trouble_);
  }
  return awaits_reply_ ? now.mono : next_request_;
}

/// Returns false if the port is lost.
bool UmbSensor::ask(MonoTime now, sensor::Sink& sink) {
  using decode::lufft::kUmbChannels;
  using decode::lufft::kUmbWindChannels;
  drop_old_input();
  const auto request = asks_for_all_ ? decode::lufft::umb_request(settings_.device, kUmbChannels)
                                     : decode::lufft::umb_request(settings_.device, kUmbWindChannels);
  if (!port_->write(request)) return false;
  sink.raw(sensor::RawDirection::kSent, request);
  awaits_reply_ = true;
  trouble_.clear();
  reply_due_ = now + settings_.response_timeout;
  next_request_ = now + settings_.poll_interval;
  return true;
}

/// Earlier bytes are not a reply.
void UmbSensor::drop_old_input() {
  static_cast<void>(assembler_.cut());
  for (int i = 0; i < kForgottenBlocks && port_->read(buffer_, 0ns).status == bus::ByteStatus::kBytes; ++i) {
  }
}

void UmbSensor::take(decode::ByteSpan bytes, const Instant& now, sensor::Sink& sink) {
  while (const auto frame = assembler_.next(bytes)) {
    if (*frame) {
      take_frame(**frame, now, sink);
    } else {
      refuse(frame->error(), fmt::format("replies arrive damaged from {}: check its cable and baud", where_), sink);
    }
  }
}

void UmbSensor::take_frame(decode::ByteSpan frame, const Instant& now, sensor::Sink& sink) {
  sink.raw(sensor::RawDirection::kReceived, frame);
  const auto reply = decode::lufft::decode_umb_reply(settings_.device, frame);
  if (reply) return take_reply(*reply, now, sink);
  switch (reply.error()) {
    case Refusal::kNotMine:
      // A line with one pair of wires echoes the request; another program may ask another device.
      if (decode::lufft::is_umb_controller(decode::little_endian_16(frame, 4))) return;
      return refuse(Refusal::kNotMine,
                    fmt::format("a device other than {} replies at {}: check class and id", name_, where_), sink);
    case Refusal::kException:
      awaits_reply_ = false;
      vain_requests_ = 0;
      asks_for_all_ = !asks_for_all_;
      return refuse(
          Refusal::kException,
          fmt::format("{} at {} refuses the query of its channels (status {:02X}h)", name_, where_, frame[10]), sink);
    default:
      return refuse(reply.error(), fmt::format("{} at {} sends an unknown reply: check class and id", name_, where_),
                    sink);
  }
}

void UmbSensor::take_reply(const decode::lufft::UmbReply& reply, const Instant& now, sensor::Sink& sink) {
  awaits_reply_ = false;
  vain_requests_ = 0;
  auto quantities = decode::lufft::quantities_of(reply);
  quantities.time = now;
  sink.quantities(quantities);

  const auto wind = decode::lufft::wind_of(reply);
  if (!wind || !wind->speed_m_s) {
    const decode::lufft::UmbChannel* const speed = reply.find(decode::lufft::umb_channel::kSpeed);
    const std::uint8_t status = speed == nullptr ? 0 : speed->status;
    refuse(wind ? Refusal::kInvalid : wind.error(),
           fmt::format("{} at {} has no wind (status {:02X}h): {}", name_, where_, status, trouble_of_status(status)),
           sink);
    is_there_ = true;
    return;
  }
  last_reading_ = now.mono;
  trouble_.clear();
  report_connected(sink, fmt::format("{} at {}", name_, where_));
  const bool is_uncertain = wind->status == decode::DecodedStatus::kUncertain;
  sink.reading({.time = now,
                .speed_m_s = *wind->speed_m_s,
                .direction_deg = wind->direction_deg,
                .gust_m_s = wind->gust_m_s,
                .quality = is_uncertain ? wind::ReadingQuality::kUncertain : wind::ReadingQuality::kGood});
}

void UmbSensor::refuse(Refusal why, const std::string& trouble, sensor::Sink& sink) {
  sink.refused(why);
  trouble_ = trouble;
  is_there_ = false;
}

/// The next request waits until a late reply has passed, which must not be taken for the next one.
Result<void, Failure> UmbSensor::give_up_reply(MonoTime now, sensor::Sink& sink) {
  awaits_reply_ = false;
  next_request_ = now + std::max(kLatestReply, settings_.poll_interval);
  if (assembler_.cut()) {
    refuse(Refusal::kTooShort, fmt::format("replies arrive damaged from {}: check its cable and baud", where_), sink);
  } else {
    const std::string trouble = trouble_.empty() ? silence_trouble() : trouble_;
    refuse(Refusal::kTimeout, trouble, sink);
  }
  if (++vain_requests_ >= kVainRequests) return Failure{trouble_ + "; reopening it"};
  return {};
}

std::string UmbSensor::silence_trouble() const {
  const bool is_serial = settings_.address.kind == bus::BytePortKind::kSerial;
  return fmt::format("{} at {} does not reply: check {}, class and id, and that it uses the UMB protocol", name_,
                     where_, is_serial ? "its power, its wires and baud" : "its power and the network");
}

}  // namespace yuragi::drivers::lufft
