#include "drivers/json/json_sensor.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::json {
namespace {

using namespace std::chrono_literals;
using bus::HttpTrouble;
using decode::Refusal;

constexpr int kOk = 200;
constexpr int kNotModified = 304;
/// The longest wait after an error: ten polls, but not longer than this unless `every` is.
constexpr Nanoseconds kMaxErrorWait = 15min;
/// What a server can ask for at most.
constexpr Nanoseconds kMaxRetryAfter = 1h;
/// A poll that comes a little early still counts as after `interval`.
constexpr int kEarlyPart = 2;

Nanoseconds longest_wait(Nanoseconds every) {
  return std::max(every, std::min<Nanoseconds>(10 * every, kMaxErrorWait));
}

Nanoseconds unchanged_after(const Settings& settings) {
  return interval_of(settings) - std::min(interval_of(settings), settings.every) / kEarlyPart;
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Refusal refusal_of(HttpTrouble trouble) {
  if (trouble == HttpTrouble::kTimeout) return Refusal::kTimeout;
  return trouble == HttpTrouble::kCut ? Refusal::kTooShort : Refusal::kMalformed;
}

bool is_redirect(int status) {
  return status == 301 || status == 302 || status == 303 || status == 307 || status == 308;
}

/// What to do about a status of HTTP.
std::string_view remedy_of(int status) {
  switch (status) {
    case 401:
    case 403:
      return "check the key in headers_file or url";
    case 404:
    case 410:
      return "check url";
    case 429:
      return "too many requests: increase `every`";
    default:
      return status >= 500 ? "the server has a problem; it is asked again" : "check url and headers_file";
  }
}

}  // namespace

Nanoseconds interval_of(const Settings& settings) {
  if (settings.interval <= Nanoseconds::zero()) return 10 * settings.every;
  return std::max(settings.interval, settings.every);
}

Sensor::Sensor(const Settings& settings, std::string where, std::unique_ptr<bus::HttpClient> client)
    : sensor::ReopeningSensor(sensor::seed_of("json" + where)),
      settings_(settings),
      where_(std::move(where)),
      client_(std::move(client)),
      errors_(settings.every, longest_wait(settings.every), sensor::seed_of(where_)),
      watch_(unchanged_after(settings), settings.silence) {}

Result<MonoTime, Failure> Sensor::open(const sensor::Clock& clock) {
  return clock.now().mono;
}

Result<MonoTime, Failure> Sensor::work(const sensor::Clock& clock, sensor::Sink& sink) {
  const MonoTime asked_at = clock.now().mono;
  sink.raw(sensor::RawDirection::kSent, bytes_of("GET from " + where_));
  const auto reply = client_->get(etag_);
  const Instant now = clock.now();
  if (!reply) {
    if (reply.error().trouble == HttpTrouble::kInterrupted) return Failure{"interrupted"};
    return now.mono + take_failure(reply.error(), sink);
  }
  if (!reply->body.empty()) sink.raw(sensor::RawDirection::kReceived, bytes_of(reply->body));
  if (reply->status == kNotModified && !etag_.empty() && watch_.last()) {
    errors_.reset();
    publish(watch_.take_unchanged(now), now, sink);
  } else if (reply->status == kOk) {
    errors_.reset();
    take_body(*reply, now, sink);
  } else {
    etag_.clear();
    return now.mono + take_error_status(*reply, sink);
  }
  return asked_at + settings_.every;
}

/// Returns the wait until the next poll, as the next one does.
Nanoseconds Sensor::take_failure(const bus::HttpFailure& failure, sensor::Sink& sink) {
  switch (failure.trouble) {
    case HttpTrouble::kTimeout:
      refuse(Refusal::kTimeout,
             fmt::format("{} does not reply within {:g} s: check the server and the network", where_,
                         seconds(settings_.resource.timeout)),
             sink);
      break;
    case HttpTrouble::kTooLong:
      refuse(Refusal::kMalformed,
             fmt::format("the answer of {} is too long (maximum {} bytes): check url", where_,
                         settings_.resource.max_body),
             sink);
      break;
    case HttpTrouble::kCertificate:
      report_unusable(sink, fmt::format("the certificate of {} is not trusted ({}): check url and this machine's date; "
                                        "ca_file names a CA of your own",
                                        where_, failure.reason));
      break;
    case HttpTrouble::kCut:
    case HttpTrouble::kNotHttp:
      refuse(refusal_of(failure.trouble),
             fmt::format("the answer of {} is damaged ({}): check url and the network", where_, failure.reason), sink);
      break;
    case HttpTrouble::kUnreachable:
    case HttpTrouble::kInterrupted:
      report_unusable(sink, fmt::format("cannot connect to {}: {}", where_, failure.reason));
      break;
  }
  return errors_.next();
}

Nanoseconds Sensor::take_error_status(const bus::HttpReply& reply, sensor::Sink& sink) {
  if (is_redirect(reply.status)) {
    const std::string to = reply.redirect_host.empty() ? "" : " to " + reply.redirect_host;
    refuse(Refusal::kException,
           fmt::format("{} redirects{} (HTTP {}), which is not followed: set url to the new address, which "
                       "`curl -I URL` shows",
                       where_, to, reply.status),
           sink);
  } else {
    refuse(Refusal::kException,
           fmt::format("{} replies with HTTP {}: {}", where_, reply.status, remedy_of(reply.status)), sink);
  }
  const Nanoseconds wanted = std::min<Nanoseconds>(reply.retry_after.value_or(Nanoseconds::zero()), kMaxRetryAfter);
  return std::max(errors_.next(), wanted);
}

void Sensor::take_body(const bus::HttpReply& reply, const Instant& now, sensor::Sink& sink) {
  const auto observation = decode::network::decode_json_wind(reply.body, settings_.places);
  if (!observation) {
    etag_.clear();
    return refuse(observation.error(), trouble_of(observation.error(), reply.body), sink);
  }
  etag_ = reply.etag;
  publish(watch_.take(*observation, now), now, sink);
}

void Sensor::publish(Novelty novelty, const Instant& now, sensor::Sink& sink) {
  const decode::network::JsonWind& last = *watch_.last();
  if (novelty == Novelty::kOld)
    return refuse(Refusal::kInvalid,
                  fmt::format("the observation of {} is older than {:g} s: check the station behind it, and this "
                              "machine's clock",
                              where_, seconds(settings_.silence)),
                  sink);
  report_connected(sink, "server " + where_);
  if (novelty == Novelty::kRepeated) return;
  const bool is_uncertain = last.wind.status == decode::DecodedStatus::kUncertain;
  sink.reading({.time = now,
                .speed_m_s = *last.wind.speed_m_s,
                .direction_deg = last.wind.direction_deg,
                .gust_m_s = last.wind.gust_m_s,
                .quality = is_uncertain ? wind::ReadingQuality::kUncertain : wind::ReadingQuality::kGood});
}

void Sensor::refuse(Refusal why, const std::string& detail, sensor::Sink& sink) {
  sink.refused(why);
  report_unusable(sink, detail);
}

std::string Sensor::trouble_of(Refusal why, const std::string& body) const {
  if (why == Refusal::kInvalid)
    return fmt::format("the answer of {} has no speed at {}: check `speed`, and the anemometer", where_,
                       settings_.places.speed);
  if (why == Refusal::kImplausible)
    return fmt::format("no wind is as fast as {} has at {}: check `speed` and speed_unit", where_,
                       settings_.places.speed);
  const bool is_page = decode::trimmed(body).starts_with('<');
  const bool is_json = decode::trimmed(body).starts_with('{') || decode::trimmed(body).starts_with('[');
  if (is_json)
    return fmt::format("the answer of {} is damaged JSON, or has no number at {}: check `speed`", where_,
                       settings_.places.speed);
  return fmt::format("the answer of {} is {}: check url", where_, is_page ? "a web page, not JSON" : "not JSON");
}

}  // namespace yuragi::drivers::json
