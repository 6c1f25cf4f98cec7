#include "drivers/davis/vantage_sensor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace yuragi::drivers::davis {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kWakeUp = "\n";
/// Of the setup bits, among them the rain collector.
constexpr std::string_view kReadSetup = "EEBRD 2B 01\n";
constexpr std::uint8_t kAcknowledged = 0x06;

/// The manual: three tries, 1.2 s apart.
constexpr Nanoseconds kWakePatience = 1200ms;
constexpr int kWakeTries = 3;
constexpr Nanoseconds kReplyPatience = 2s;
/// Between a console's reply and the next request: a WeatherLinkIP loses a request that follows immediately (weewx).
constexpr Nanoseconds kRest = 100ms;
/// A read returns at least this often, so that timeouts are checked.
constexpr Nanoseconds kMaxRead = 200ms;
constexpr int kForgottenBlocks = 16;

/// Consoles end by themselves after about 220 (weewx).
constexpr int kPacketsAsked = 200;
constexpr int kLastPackets = 2;
/// A packet comes every 2 to 2.5 s.
constexpr Nanoseconds kPacketPatience = 6s;
/// The bytes of one packet follow each other faster.
constexpr Nanoseconds kPacketCut = 1s;
constexpr int kVainRequests = 4;
/// Without wind in the packets for this time, the station has a problem.
constexpr Nanoseconds kWindPatience = 10s;
/// The time that a console needs to end its packets.
constexpr Nanoseconds kFarewell = 100ms;

decode::ByteSpan bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

VantageSensor::VantageSensor(const VantageSettings& settings, std::unique_ptr<bus::BytePort> port)
    : sensor::ReopeningSensor(sensor::seed_of(describe(settings.address))),
      settings_(settings),
      where_(describe(settings.address)),
      port_(std::move(port)) {}

VantageSensor::~VantageSensor() {
  VantageSensor::close();
}

Result<MonoTime, Failure> VantageSensor::open(const sensor::Clock& clock) {
  if (const auto opened = port_->open(); !opened) return opened.error();
  const MonoTime now = clock.now().mono;
  vain_requests_ = 0;
  asks_for_loop2_ = settings_.packets != VantagePackets::kLoop;
  has_asked_for_setup_ = false;
  rain_of_a_tip_mm_.reset();
  last_bytes_ = last_packet_ = last_reading_ = now;
  enter(Phase::kWake, now);
  return now;
}

/// A wake-up ends the packets of a console. The port stays open for a moment, so that the console can read the wake-up.
void VantageSensor::close() noexcept {
  if (std::exchange(phase_, Phase::kWake) == Phase::kReceive && port_->write(bytes_of(kWakeUp))) {
    port_->read(buffer_, kFarewell);
  }
  port_->close();
}

void VantageSensor::enter(Phase phase, MonoTime now) {
  phase_ = phase;
  awaits_reply_ = false;
  next_request_ = now + kRest;
  wake_tries_ = 0;
}

Result<MonoTime, Failure> VantageSensor::work(const sensor::Clock& clock, sensor::Sink& sink) {
  const MonoTime start = clock.now().mono;
  if (phase_ != Phase::kReceive && !awaits_reply_) {
    if (start < next_request_) return next_request_;
    if (!send_request(start, sink)) return Failure{where_ + " does not accept requests: reopening it"};
  }

  const MonoTime due = phase_ == Phase::kReceive ? start + kMaxRead : reply_due_;
  const bus::ByteArrival arrival = port_->read(buffer_, std::clamp<Nanoseconds>(due - start, 0ns, kMaxRead));
  const Instant now = clock.now();
  Result<void, Failure> done;
  switch (arrival.status) {
    case bus::ByteStatus::kInterrupted:
      return now.mono;
    case bus::ByteStatus::kLost:
    case bus::ByteStatus::kEnd:
      phase_ = Phase::kWake;  // the console is disconnected: close() need not end its packets
      return Failure{where_ + " is gone: it is reopened when it is back; check its plug, its power and the network"};
    case bus::ByteStatus::kBytes:
      done = take(decode::ByteSpan(buffer_).first(arrival.size), now, sink);
      break;
    case bus::ByteStatus::kForeign:
    case bus::ByteStatus::kSilence:
      break;
  }
  // Only after all that has been received.
  if (done && awaits_reply_ && now.mono >= reply_due_) done = give_up_reply(now.mono, sink);
  if (done && phase_ == Phase::kReceive) done = doubt_packets(now.mono, sink);
  if (!done) return done.error();
  return now.mono;
}

std::string VantageSensor::request() const {
  if (phase_ == Phase::kWake) return std::string(kWakeUp);
  if (phase_ == Phase::kSetup) return std::string(kReadSetup);
  return fmt::format("{} {}\n", asks_for_loop2_ ? "LPS 2" : "LOOP", kPacketsAsked);
}

/// Returns false if the port is lost.
bool VantageSensor::send_request(MonoTime now, sensor::Sink& sink) {
  drop_old_input();
  const std::string request = this->request();
  if (!port_->write(bytes_of(request))) return false;
  sink.raw(sensor::RawDirection::kSent, bytes_of(request));
  awaits_reply_ = true;
  reply_size_ = 0;
  reply_due_ = now + (phase_ == Phase::kWake ? kWakePatience : kReplyPatience);
  return true;
}

/// Earlier data of a console is not a reply.
void VantageSensor::drop_old_input() {
  assembler_.cut();
  for (int i = 0; i < kForgottenBlocks && port_->read(buffer_, 0ns).status == bus::ByteStatus::kBytes; ++i) {
  }
}

Result<void, Failure> VantageSensor::take(decode::ByteSpan bytes, const Instant& now, sensor::Sink& sink) {
  if (phase_ == Phase::kReceive) {
    take_packets(bytes, now, sink);
    return {};
  }
  sink.raw(sensor::RawDirection::kReceived, bytes);
  return take_reply(bytes, now, sink);
}

/// A reply may come in pieces, and after the LF CR of a wake-up that came late.
Result<void, Failure> VantageSensor::take_reply(decode::ByteSpan bytes, const Instant& now, sensor::Sink& sink) {
  for (; !bytes.empty(); bytes = bytes.subspan(1)) {
    const std::uint8_t byte = bytes.front();
    if (phase_ == Phase::kWake) {
      const bool is_awake = reply_size_ == 1 && reply_[0] == '\n' && byte == '\r';
      reply_[0] = byte;
      reply_size_ = 1;
      if (is_awake && bytes.size() == 1) enter(has_asked_for_setup_ ? Phase::kAsk : Phase::kSetup, now.mono);
      continue;
    }
    if (reply_size_ == 0 && (byte == '\n' || byte == '\r')) continue;
    reply_[reply_size_++] = byte;
    if (reply_[0] != kAcknowledged) {
      sink.refused(decode::Refusal::kException);
      return give_up_reply(now.mono, sink);
    }
    if (phase_ == Phase::kSetup && reply_size_ == 4) {
      take_setup(decode::ByteSpan(reply_).subspan(1, 3), now.mono, sink);
      return {};
    }
    if (phase_ == Phase::kAsk) {
      enter(Phase::kReceive, now.mono);
      packets_left_ = kPacketsAsked;
      last_bytes_ = last_packet_ = now.mono;
      take_packets(bytes.subspan(1), now, sink);
      return {};
    }
  }
  return {};
}

void VantageSensor::take_setup(decode::ByteSpan reply, MonoTime now, sensor::Sink& sink) {
  has_asked_for_setup_ = true;
  if (const auto rain_of_a_tip_mm = decode::davis::decode_vantage_rain_of_a_tip_mm(reply)) {
    rain_of_a_tip_mm_ = *rain_of_a_tip_mm;
  } else {
    sink.refused(rain_of_a_tip_mm.error());
  }
  enter(Phase::kAsk, now);
}

void VantageSensor::take_packets(decode::ByteSpan bytes, const Instant& now, sensor::Sink& sink) {
  if (now.mono - last_bytes_ >= kPacketCut && assembler_.cut()) {
    has_damaged_packets_ = true;
    sink.refused(decode::Refusal::kTooShort);
  }
  if (!bytes.empty()) last_bytes_ = now.mono;
  while (const auto packet = assembler_.next(bytes)) {
    if (*packet) {
      take_packet(**packet, now, sink);
    } else {
      has_damaged_packets_ = true;
      sink.refused(packet->error());
    }
    if (*packet || packet->error() == decode::Refusal::kBadChecksum) --packets_left_;
  }
  if (phase_ == Phase::kReceive && packets_left_ <= kLastPackets) enter(Phase::kWake, now.mono);
}

void VantageSensor::take_packet(decode::ByteSpan packet, const Instant& now, sensor::Sink& sink) {
  sink.raw(sensor::RawDirection::kReceived, packet);
  last_packet_ = now.mono;
  vain_requests_ = 0;
  has_damaged_packets_ = false;
  if (auto quantities = decode::davis::decode_vantage_quantities(packet, rain_of_a_tip_mm_)) {
    quantities->time = now;
    sink.quantities(*quantities);
  }
  const auto wind = decode::davis::decode_vantage_packet(packet);
  if (!wind) {
    sink.refused(wind.error());
    if (now.mono - last_reading_ >= kWindPatience) {
      report_connected(sink, fmt::format("the Davis console at {} has no wind: check the anemometer's radio or cable, "
                                         "its battery and its cups",
                                         where_));
    }
    return;
  }
  last_reading_ = now.mono;
  report_connected(sink, fmt::format("Davis console ({}) at {}", asks_for_loop2_ ? "LOOP2" : "LOOP", where_));
  const bool is_uncertain = wind->status == decode::DecodedStatus::kUncertain;
  sink.reading({.time = now,
                .speed_m_s = *wind->speed_m_s,
                .direction_deg = wind->direction_deg,
                .gust_m_s = wind->gust_m_s,
                .quality = is_uncertain ? wind::ReadingQuality::kUncertain : wind::ReadingQuality::kGood});
}

/// No reply in time, or another one.
Result<void, Failure> VantageSensor::give_up_reply(MonoTime now, sensor::Sink& sink) {
  const bool is_late = now >= reply_due_;
  if (is_late) sink.refused(decode::Refusal::kTimeout);
  awaits_reply_ = false;
  next_request_ = now;
  switch (phase_) {
    case Phase::kWake:
      if (++wake_tries_ < kWakeTries) return {};
      return Failure{fmt::format("{} does not wake up: check the console's power, the logger's plug{}", where_,
                                 settings_.address.kind == bus::BytePortKind::kSerial
                                     ? " and baud"
                                     : " and that no other program is connected")};
    case Phase::kSetup:
      has_asked_for_setup_ = true;  // once: the wind does not need it
      enter(Phase::kWake, now);
      return {};
    case Phase::kAsk:
      return give_up_asking(now);
    case Phase::kReceive:
      break;
  }
  return {};
}

/// A console with firmware before 1.90 does not know LPS.
Result<void, Failure> VantageSensor::give_up_asking(MonoTime now) {
  if (settings_.packets == VantagePackets::kAuto) asks_for_loop2_ = !asks_for_loop2_;
  if (++vain_requests_ >= kVainRequests) {
    return Failure{where_ + " wakes up, but sends no packets: check that it is a Davis console"};
  }
  enter(Phase::kWake, now);
  return {};
}

Result<void, Failure> VantageSensor::doubt_packets(MonoTime now, sensor::Sink& sink) {
  if (now - last_packet_ < kPacketPatience) return {};
  if (now - last_bytes_ >= kPacketPatience) sink.refused(decode::Refusal::kTimeout);
  const std::string trouble =
      has_damaged_packets_ ? fmt::format("packets arrive damaged from {}: check its cable and baud", where_)
                           : fmt::format("{} was asked for packets, but sends none: check its power and cable", where_);
  has_damaged_packets_ = false;
  report_unusable(sink, trouble);
  if (++vain_requests_ >= kVainRequests) return Failure{trouble};
  enter(Phase::kWake, now);
  return {};
}

}  // namespace yuragi::drivers::davis
