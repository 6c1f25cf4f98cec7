#include "drivers/modbus/modbus_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace yuragi::drivers::modbus {
namespace {

constexpr Nanoseconds kFirstSlaveWait = std::chrono::milliseconds(250);
constexpr Nanoseconds kMaxSlaveWait = std::chrono::seconds(10);
/// For recorded quantities only, so that a device without them is rarely asked.
constexpr Nanoseconds kMaxQuantitiesWait = std::chrono::minutes(10);

/// Returns true if a gateway reports that a slave does not reply.
bool is_silence_by_proxy(const Trouble& trouble) {
  return trouble.kind == Trouble::Kind::kRefused && trouble.refusal.why == decode::Refusal::kException &&
         decode::modbus::is_gateway_silence(trouble.refusal.exception);
}

/// "without direction and gust", for the quantities of this read.
std::string without(const Profile& profile, const RegisterRead& read) {
  if (!read.has_wind()) {
    std::vector<std::string_view> names;
    for (const std::size_t station : read.stations) names.push_back(profile.quantities[station].what.name);
    return fmt::format("without {}", fmt::join(names, " and "));
  }
  const bool has_direction = read.contains(Measure::kDirection);
  const bool has_gust = read.contains(Measure::kGust);
  return fmt::format("without {}{}{}", has_direction ? "direction" : "", has_direction && has_gust ? " and " : "",
                     has_gust ? "gust" : "");
}

}  // namespace

Sensor::Sensor(Profile profile, std::shared_ptr<Bus> bus, const std::shared_ptr<Bus>& direction_bus, std::uint32_t seed)
    : sensor::ReopeningSensor(seed),
      profile_(std::move(profile)),
      bus_(std::move(bus)),
      direction_bus_(direction_bus ? direction_bus : bus_) {
  const bool is_direction_apart = direction_bus_ != bus_;
  for (const RegisterRead& what : plan_modbus_reads(profile_, is_direction_apart)) {
    Bus* const line = is_direction_apart && what.contains(Measure::kDirection) ? direction_bus_.get() : bus_.get();
    const platform::Backoff backoff =
        what.has_wind() ? platform::Backoff(kFirstSlaveWait, kMaxSlaveWait, ++seed)
                        : platform::Backoff(profile_.quantities_interval,
                                            std::max(profile_.quantities_interval, kMaxQuantitiesWait), ++seed);
    reads_.push_back({.what = what, .bus = line, .backoff = backoff, .trouble = {}});
  }
  wind_reads_ =
      static_cast<std::size_t>(std::ranges::count_if(reads_, [](const Read& read) { return read.what.has_wind(); }));
  bus_->keep_gap(profile_.min_gap);
  direction_bus_->keep_gap(profile_.min_gap);
}

void Sensor::interrupt() noexcept {
  interruption_.set();
  bus_->wake_waiters();
  direction_bus_->wake_waiters();
}

Result<MonoTime, Failure> Sensor::open(const sensor::Clock& clock) {
  const auto opened = bus_->open(interruption_, clock);
  if (!opened) return opened.error();
  opened_at_ = *opened;
  step_ = 0;
  return std::max(clock.now().mono, opened_at_ + profile_.delay_after_open);
}

Result<MonoTime, Failure> Sensor::work(const sensor::Clock& clock, sensor::Sink& sink) {
  if (step_ > 0) {
    read_more(reads_[step_], clock, sink);
    return go_on(clock.now(), sink);
  }
  // The line may have been reopened since, by another sensor or after silence.
  const MonoTime opened_before = opened_at_;
  auto begin = open(clock);
  if (!begin || opened_at_ != opened_before) return begin;
  return read_first(clock, sink);
}

Result<MonoTime, Failure> Sensor::read_first(const sensor::Clock& clock, sensor::Sink& sink) {
  Read& read = reads_.front();
  const MonoTime ready_at = bus_->ready_at(read.what.request.unit);
  round_start_ = clock.now().mono;
  if (ready_at > round_start_) return ready_at;

  const Bus::Reply reply = exchange(read, clock, sink);
  const Instant now = clock.now();
  if (!reply) {
    if (reply.error().kind == Trouble::Kind::kInterrupted) return now.mono;
    if (reply.error().kind == Trouble::Kind::kLost) return Failure{explain(read, reply.error())};
    report_unusable(sink, explain(read, reply.error()));
    return now.mono + read.backoff.next();
  }
  read.backoff.reset();

  const auto speed_m_s =
      decode::modbus::decode_speed_m_s(profile_.speed, registers_of(profile_.speed, read.what.request, *reply));
  if (!speed_m_s) {
    sink.refused(speed_m_s.error());
    report_connected(sink,
                     fmt::format("slave {} at {} replies, but its speed is {}: check that the profile fits the device",
                                 read.what.request.unit, bus_->where(), name_of(speed_m_s.error())));
    return next_round(now.mono);
  }
  reading_ = {.time = now,
              .speed_m_s = *speed_m_s,
              .direction_deg = {},
              .gust_m_s = {},
              .quality = wind::ReadingQuality::kGood};
  takes_quantities_ = !profile_.quantities.empty() && round_start_ >= quantities_due_;
  quantities_ = {};
  take(read, *reply, sink);
  return go_on(now, sink);
}

void Sensor::read_more(Read& read, const sensor::Clock& clock, sensor::Sink& sink) {
  // The vane's own line, if it has one, is opened here; without it there is no direction.
  if (const auto opened = read.bus->open(interruption_, clock); !opened) {
    read.trouble = without(profile_, read.what) + ": " + opened.error().message;
    read.not_before = clock.now().mono + read.backoff.next();
    return;
  }
  const Bus::Reply reply = exchange(read, clock, sink);
  if (reply) {
    read.backoff.reset();
    take(read, *reply, sink);
    return;
  }
  read.trouble = without(profile_, read.what) + ": " + explain(read, reply.error());
  read.not_before = clock.now().mono + read.backoff.next();
}

Bus::Reply Sensor::exchange(const Read& read, const sensor::Clock& clock, sensor::Sink& sink) {
  const bus::ModbusPatience patience{.response_timeout = profile_.response_timeout,
                                     .byte_timeout = profile_.byte_timeout};
  return read.bus->exchange(read.what.request, patience, interruption_, clock, sink);
}

MonoTime Sensor::go_on(const Instant& now, sensor::Sink& sink) {
  // The due reads of this round that are not yet done. The wind does not wait for them.
  for (++step_; step_ <= reads_.size(); ++step_) {
    if (step_ == wind_reads_) publish_wind(sink);
    if (step_ == reads_.size() || (step_ >= wind_reads_ && !takes_quantities_)) break;
    const Read& read = reads_[step_];
    const bool is_due = now.mono >= read.not_before && now.mono >= read.bus->ready_at(read.what.request.unit);
    if (is_due) return read.bus == bus_.get() ? now.mono + profile_.min_gap : now.mono;
  }
  return end_round(now, sink);
}

/// All of the wind that came in this round, together.
void Sensor::publish_wind(sensor::Sink& sink) {
  if (reading_.time.mono < opened_at_ + profile_.warm_up) {
    report_connected(sink, profile_.name + " at " + bus_->where() + " is warming up");
    takes_quantities_ = false;
    return;
  }
  std::string detail = profile_.name + " at " + bus_->where();
  for (const Read& read : reads_) {
    if (!read.trouble.empty()) detail += "; " + read.trouble;
  }
  report_connected(sink, detail);
  sink.reading(reading_);
}

MonoTime Sensor::end_round(const Instant& now, sensor::Sink& sink) {
  step_ = 0;
  if (takes_quantities_) {
    quantities_due_ = round_start_ + profile_.quantities_interval;
    quantities_.time = now;
    if (const auto told = wind::plausible_part(quantities_)) sink.quantities(*told);
  }
  return next_round(now.mono);
}

MonoTime Sensor::next_round(MonoTime now) const {
  return std::max(round_start_ + profile_.poll_interval, now + profile_.min_gap);
}

void Sensor::take(Read& read, const decode::modbus::Registers& registers, sensor::Sink& sink) {
  read.trouble.clear();
  const auto part = [&](const decode::modbus::Quantity& quantity) {
    return registers_of(quantity, read.what.request, registers);
  };
  if (read.what.contains(Measure::kDirection)) take_direction(read, part(*profile_.direction), sink);
  if (read.what.contains(Measure::kGust)) take_gust(read, part(*profile_.gust), sink);
  if (!takes_quantities_) return;
  for (const std::size_t station : read.what.stations) {
    take_station(profile_.quantities[station], part(profile_.quantities[station].quantity), sink);
  }
}

void Sensor::take_direction(Read& read, std::span<const std::uint16_t> registers, sensor::Sink& sink) {
  const auto direction_deg = decode::modbus::decode_direction_deg(*profile_.direction, registers);
  if (!direction_deg) {
    sink.refused(direction_deg.error());
    read.trouble = fmt::format("without direction: it is {}", name_of(direction_deg.error()));
    return;
  }
  // A sum just below 0 may round up to 360 itself.
  const double turned_deg = std::fmod(*direction_deg + profile_.north_offset_deg + 360.0, 360.0);
  reading_.direction_deg = turned_deg < 360.0 ? turned_deg : 0.0;
}

void Sensor::take_gust(Read& read, std::span<const std::uint16_t> registers, sensor::Sink& sink) {
  const auto gust_m_s = decode::modbus::decode_speed_m_s(*profile_.gust, registers);
  if (!gust_m_s) {
    sink.refused(gust_m_s.error());
    read.trouble +=
        fmt::format("{}without gust: it is {}", read.trouble.empty() ? "" : "; ", name_of(gust_m_s.error()));
    return;
  }
  reading_.gust_m_s = *gust_m_s;
}

void Sensor::take_station(const StationQuantity& station, std::span<const std::uint16_t> registers,
                          sensor::Sink& sink) {
  const auto value = decode::modbus::decode_number(station.quantity, registers);
  if (value) {
    quantities_.*station.what.value = *value;
  } else if (value.error() != decode::Refusal::kInvalid) {
    sink.refused(value.error());
  }
}

std::string Sensor::explain(const Read& read, const Trouble& trouble) const {
  const std::string slave = fmt::format("slave {} at {}", read.what.request.unit, read.bus->where());
  switch (trouble.kind) {
    case Trouble::Kind::kSilence:
      return fmt::format("{} does not reply within {:g} s: check its power, its wiring and its id", slave,
                         seconds(profile_.response_timeout));
    case Trouble::Kind::kOthersOnly:
      return slave +
             " does not reply, but other slaves do: check its id, and that there is no other master on its line";
    case Trouble::Kind::kLost:
      return "the connection to " + read.bus->where() + " was lost: reopening it";
    case Trouble::Kind::kInterrupted:
      return "interrupted";
    case Trouble::Kind::kRefused:
      break;
  }
  const decode::modbus::RefusedReply& refusal = trouble.refusal;
  if (is_silence_by_proxy(trouble)) {
    return fmt::format(
        "the gateway reports that {} does not reply (exception {}, {}): check its power, its wiring and its "
        "id",
        slave, refusal.exception, decode::modbus::modbus_exception_name(refusal.exception));
  }
  if (refusal.why == decode::Refusal::kException) {
    return fmt::format("{} refuses the request (exception {}, {}): check that the profile fits the device", slave,
                       refusal.exception, decode::modbus::modbus_exception_name(refusal.exception));
  }
  return fmt::format(
      "a reply of {} is invalid ({}): check wiring and termination, baud rate, parity, and that no other device has "
      "its id",
      slave, name_of(refusal.why));
}

}  // namespace yuragi::drivers::modbus
