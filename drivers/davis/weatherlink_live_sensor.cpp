#include "drivers/davis/weatherlink_live_sensor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace yuragi::drivers::davis {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kConditionsTarget = "/v1/current_conditions";
/// The maker allows up to a day. They cannot be stopped, so a short time makes a device that is no longer used fall
/// silent soon.
constexpr std::string_view kBroadcastsTarget = "/v1/real_time?duration=300";
constexpr Nanoseconds kRenewal = 120s;
/// The maker: conditions at most every 10 s.
constexpr Nanoseconds kConditionsInterval = 10s;
constexpr Nanoseconds kRetry = 10s;
constexpr Nanoseconds kHttpPatience = 5s;
constexpr Nanoseconds kLiveLongestRead = 200ms;
constexpr Nanoseconds kHttpRead = 50ms;
/// Broadcasts come every 2.5 s.
constexpr Nanoseconds kBroadcastPatience = 10s;
/// Without any message for this time the device counts as lost.
constexpr Nanoseconds kLivePatience = 30s;

std::string_view text_of(const std::vector<std::uint8_t>& buffer, std::size_t size) {
  return {reinterpret_cast<const char*>(buffer.data()), size};
}

}  // namespace

WeatherLinkLiveSensor::WeatherLinkLiveSensor(const WeatherLinkLiveSettings& settings,
                                             std::unique_ptr<bus::BytePort> http,
                                             std::unique_ptr<bus::BytePort> broadcasts)
    : sensor::ReopeningSensor(sensor::seed_of(describe(settings.http))),
      settings_(settings),
      where_(describe(settings.http)),
      http_(settings.http.host, std::move(http)),
      broadcasts_(std::move(broadcasts)),
      buffer_(bus::kMaxDatagram) {}

void WeatherLinkLiveSensor::interrupt() noexcept {
  http_.interrupt();
  broadcasts_->interrupt();
}

Result<MonoTime, Failure> WeatherLinkLiveSensor::open(const sensor::Clock& clock) {
  if (const auto opened = broadcasts_->open(); !opened) return opened.error();
  const MonoTime now = clock.now().mono;
  next_conditions_ = next_renewal_ = last_broadcast_ = last_message_ = now;
  trouble_.clear();
  advice_.clear();
  device_.clear();
  transmitter_ = settings_.transmitter;
  is_received_ = true;
  has_broadcast_ = false;
  return now;
}

void WeatherLinkLiveSensor::close() noexcept {
  http_.end();
  broadcasts_->close();
}

Result<MonoTime, Failure> WeatherLinkLiveSensor::work(const sensor::Clock& clock, sensor::Sink& sink) {
  if (!http_.is_under_way()) begin_request(clock, sink);
  if (http_.is_under_way()) advance_request(clock.now(), sink);

  const bus::ByteArrival arrival = broadcasts_->read(buffer_, http_.is_under_way() ? 0ns : kLiveLongestRead);
  const Instant now = clock.now();
  if (arrival.overrun > 0) sink.refused(decode::Refusal::kOverrun, arrival.overrun);
  switch (arrival.status) {
    case bus::ByteStatus::kInterrupted:
      return now.mono;
    case bus::ByteStatus::kLost:
    case bus::ByteStatus::kEnd:
      return Failure{describe(settings_.broadcasts) + " is gone: reopening it"};
    case bus::ByteStatus::kForeign:
      sink.refused(decode::Refusal::kNotMine);
      break;
    case bus::ByteStatus::kBytes:
      take_broadcast(text_of(buffer_, arrival.size), now, sink);
      break;
    case bus::ByteStatus::kSilence:
      break;
  }
  if (now.mono - last_message_ >= kLivePatience) {
    sink.refused(decode::Refusal::kTimeout);
    return Failure{trouble_.empty() ? where_ + " is silent: check its power and network" : trouble_};
  }
  return now.mono;
}

bool WeatherLinkLiveSensor::has_broadcasts(MonoTime now) const {
  return has_broadcast_ && now - last_broadcast_ < kBroadcastPatience;
}

/// The conditions come first, because they have the id of the device whose broadcasts are accepted.
void WeatherLinkLiveSensor::begin_request(const sensor::Clock& clock, sensor::Sink& sink) {
  MonoTime now = clock.now().mono;
  if (now >= next_conditions_) {
    request_ = Request::kConditions;
    next_conditions_ = now + kConditionsInterval;
  } else if (!device_.empty() && now >= next_renewal_) {
    request_ = Request::kBroadcasts;
    next_renewal_ = now + kRetry;
  } else {
    return;
  }
  const std::string target(request_ == Request::kConditions ? kConditionsTarget : kBroadcastsTarget);
  const auto begun = http_.begin(target);
  now = clock.now().mono;
  if (!begun) return fail_request(now, begun.error().message, sink);
  sink.raw(sensor::RawDirection::kSent, {reinterpret_cast<const std::uint8_t*>(target.data()), target.size()});
  request_due_ = now + kHttpPatience;
}

void WeatherLinkLiveSensor::advance_request(const Instant& now, sensor::Sink& sink) {
  const auto reply = http_.advance(kHttpRead);
  if (!reply) {
    if (now.mono < request_due_) return;
    http_.end();
    sink.refused(decode::Refusal::kTimeout);
    return fail_request(now.mono, where_ + " does not reply: check that it is a WeatherLink Live", sink);
  }
  if (!*reply) {
    sink.refused(decode::Refusal::kMalformed);
    return fail_request(now.mono,
                        fmt::format("{} replies with an error ({}): check that it is a WeatherLink Live", where_,
                                    reply->error().message),
                        sink);
  }
  const std::string& body = **reply;
  sink.raw(sensor::RawDirection::kReceived, {reinterpret_cast<const std::uint8_t*>(body.data()), body.size()});
  if (request_ == Request::kConditions) {
    take_conditions(body, now, sink);
  } else {
    take_broadcast_port(body, now.mono, sink);
  }
}

/// While broadcasts arrive nothing is lost yet; and if only they are missing, the conditions have a wind.
void WeatherLinkLiveSensor::fail_request(MonoTime now, const std::string& why, sensor::Sink& sink) {
  if (request_ == Request::kBroadcasts) {
    advice_ = ": " + why;
    return;
  }
  trouble_ = why;
  if (!has_broadcasts(now)) report_unusable(sink, trouble_);
}

void WeatherLinkLiveSensor::take_conditions(std::string_view json, const Instant& now, sensor::Sink& sink) {
  auto conditions = decode::davis::decode_live_conditions(json, transmitter_);
  is_received_ = conditions || conditions.error() != decode::Refusal::kInvalid;
  if (!conditions) {
    sink.refused(conditions.error());
    if (conditions.error() != decode::Refusal::kInvalid && conditions.error() != decode::Refusal::kNotMine) {
      return fail_request(now.mono, where_ + " sends an unknown reply: check that it is a WeatherLink Live", sink);
    }
    last_message_ = now.mono;
    return report_connected(
        sink, fmt::format("the WeatherLink Live at {} has no wind{}: check the anemometer's radio and battery, and "
                          "transmitter",
                          where_, transmitter_ == 0 ? "" : fmt::format(" of transmitter {}", transmitter_)));
  }
  trouble_.clear();
  last_message_ = now.mono;
  device_ = conditions->device;
  transmitter_ = conditions->transmitter;
  conditions->quantities.time = now;
  sink.quantities(conditions->quantities);
  if (has_broadcasts(now.mono)) return;
  next_renewal_ = std::min(next_renewal_, now.mono + kRetry);
  const bool lacks_broadcasts = now.mono - last_broadcast_ >= kBroadcastPatience;
  publish(*conditions, now, lacks_broadcasts ? ", without broadcasts" + advice_ : "", sink);
}

void WeatherLinkLiveSensor::take_broadcast_port(std::string_view json, MonoTime now, sensor::Sink& sink) {
  const auto port = decode::davis::decode_live_broadcast_port(json);
  if (!port) {
    sink.refused(port.error());
    return fail_request(now, "it refuses to send any, check its firmware", sink);
  }
  if (*port != settings_.broadcasts.port) {
    return fail_request(now, fmt::format("they go to port {}, set port to that", *port), sink);
  }
  advice_ = ": check the firewall, and that this machine is in the same network";
  next_renewal_ = now + kRenewal;
}

void WeatherLinkLiveSensor::take_broadcast(std::string_view json, const Instant& now, sensor::Sink& sink) {
  sink.raw(sensor::RawDirection::kReceived, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()});
  const auto conditions = decode::davis::decode_live_conditions(json, transmitter_);
  if (!conditions) return sink.refused(conditions.error());
  if (device_.empty() || conditions->device != device_) return sink.refused(decode::Refusal::kNotMine);
  if (!is_received_) return sink.refused(decode::Refusal::kInvalid);
  if (!limit_.admits(now.mono)) return sink.refused(decode::Refusal::kTooFrequent);
  has_broadcast_ = true;
  last_broadcast_ = last_message_ = now.mono;
  publish(*conditions, now, "", sink);
}

void WeatherLinkLiveSensor::publish(const decode::davis::LiveConditions& conditions, const Instant& now,
                                    const std::string& how, sensor::Sink& sink) {
  report_connected(sink, fmt::format("WeatherLink Live {} at {}, transmitter {}{}", conditions.device, where_,
                                     conditions.transmitter, how));
  const bool is_uncertain = conditions.wind.status == decode::DecodedStatus::kUncertain;
  sink.reading({.time = now,
                .speed_m_s = *conditions.wind.speed_m_s,
                .direction_deg = conditions.wind.direction_deg,
                .gust_m_s = conditions.wind.gust_m_s,
                .quality = is_uncertain ? wind::ReadingQuality::kUncertain : wind::ReadingQuality::kGood});
}

}  // namespace yuragi::drivers::davis
