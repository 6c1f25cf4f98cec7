#include "drivers/text/signalk_sensor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace yuragi::drivers::text {
namespace {

/// More sources and quantities than any vessel has.
constexpr std::size_t kMaxFirstTimes = 256;

using Outcome = Result<std::optional<wind::Reading>, decode::Refusal>;

/// Returns the better of two outcomes (a reading, nothing, a refusal), of equals the later one.
Outcome better_of(const Outcome& earlier, const Outcome& later) {
  const auto rank = [](const Outcome& outcome) { return !outcome ? 0 : outcome->has_value() ? 2 : 1; };
  return rank(later) >= rank(earlier) ? later : earlier;
}

}  // namespace

SignalKSensor::SignalKSensor(SignalKSensorSettings settings, std::unique_ptr<bus::BytePort> port)
    : Sensor(settings.text, std::move(port)), settings_(std::move(settings)), wind_(settings_.wind) {}

void SignalKSensor::begin() {
  wind_.restart();
  hello_ = {};
  first_times_.clear();
  moment_.reset();
}

Sensor::Judgement SignalKSensor::judge(std::string_view line, const Instant& now) {
  if (auto hello = decode::marine::signalk_hello(line)) {
    hello_ = std::move(*hello);
    return std::optional<wind::Reading>();
  }
  auto delta = decode::marine::decode_signalk(line);
  if (!delta) return delta.error();
  if (!is_of_vessel(delta->context)) return decode::Refusal::kNotMine;

  Judgement result = decode::Refusal::kNotMine;
  for (decode::marine::SignalKUpdate& update : delta->updates) {
    if (!settings_.source.empty() && update.source != settings_.source) continue;
    forget_remembered(update);
    const bool has_any = std::ranges::any_of(update.values, [](const auto& value) { return value.has_value(); });
    if (!has_any) continue;
    result = better_of(result, take(update, now));
  }
  return result;
}

/// The line's context, or that of its server.
bool SignalKSensor::is_of_vessel(const std::string& context) const {
  if (!settings_.context.empty()) return context == settings_.context;
  return context.empty() || context == "vessels.self" || hello_.self.empty() || context == hello_.self;
}

void SignalKSensor::forget_remembered(decode::marine::SignalKUpdate& update) {
  for (std::size_t quantity = 0; quantity < update.values.size(); ++quantity) {
    if (update.values[quantity] && is_remembered(update, quantity)) update.values[quantity].reset();
  }
}

/// Times of one server are written alike, so that they can be compared as texts. A source's clock may always be behind
/// the server's, so a value counts as remembered only until its time changes. Only servers, to which a client
/// subscribes, send remembered values.
bool SignalKSensor::is_remembered(const decode::marine::SignalKUpdate& update, std::size_t quantity) {
  const bus::BytePortKind kind = settings().address.kind;
  const bool is_server = kind == bus::BytePortKind::kTcpClient || kind == bus::BytePortKind::kWebSocket;
  const bool is_new = !hello_.timestamp.empty() && update.timestamp >= hello_.timestamp;
  if (!is_server || is_new || update.timestamp.empty()) return false;
  const auto first = std::ranges::find_if(
      first_times_, [&](const FirstTime& each) { return each.quantity == quantity && each.source == update.source; });
  if (first != first_times_.end()) return first->timestamp == update.timestamp;
  if (first_times_.size() < kMaxFirstTimes) first_times_.push_back({update.source, quantity, update.timestamp});
  return true;
}

Sensor::Judgement SignalKSensor::take(const decode::marine::SignalKUpdate& update, const Instant& now) {
  const bool goes_on = moment_ && !update.timestamp.empty() && moment_->source == update.source &&
                       moment_->timestamp == update.timestamp;
  Judgement before = decode::Refusal::kNotMine;
  if (!goes_on) {
    if (moment_) before = offer_moment(true);
    moment_ = Moment{.source = update.source, .timestamp = update.timestamp, .time = now};
  }
  for (std::size_t quantity = 0; quantity < update.values.size(); ++quantity) {
    if (update.values[quantity]) moment_->values[quantity] = update.values[quantity];
  }
  return better_of(before, offer_moment(false));
}

/// Offers the winds of the moment that are complete, or all that have a speed when it is over.
Sensor::Judgement SignalKSensor::offer_moment(bool is_over) {
  std::optional<wind::Reading> reading;
  bool is_foreign = false;
  const auto winds = decode::marine::signalk_winds(moment_->values);
  for (std::size_t i = 0; i < winds.size(); ++i) {
    if (!winds[i] || moment_->is_offered[i] || (!is_over && !winds[i]->wind.direction_deg)) continue;
    moment_->is_offered.set(i);
    const auto offered = wind_.offer(
        fmt::format("{} wind of {}", winds[i]->frame, moment_->source.empty() ? "Signal K" : moment_->source),
        winds[i]->wind, moment_->time);
    if (!offered) is_foreign = true;
    if (offered && *offered) reading = *offered;
  }
  if (!reading && is_foreign) return decode::Refusal::kNotMine;
  return reading;
}

std::optional<wind::Reading> SignalKSensor::take_held() {
  std::optional<wind::Reading> last;
  if (moment_) {
    const Judgement rest = offer_moment(true);
    if (rest) last = *rest;
    moment_.reset();
  }
  const auto held = wind_.take_held();
  return last ? last : held;
}

std::string SignalKSensor::name() const {
  return wind_.taken().empty() ? "Signal K" : wind_.taken();
}

std::string SignalKSensor::advice(decode::Refusal why, std::string_view line) const {
  if (why == decode::Refusal::kNotMine) {
    return describe(settings().address) +
           " sends no new wind: check its anemometer, and the settings source, context and reference";
  }
  return Sensor::advice(why, line);
}

}  // namespace yuragi::drivers::text
