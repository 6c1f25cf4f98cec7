#include "drivers/modbus_sensor.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace yuragi {
namespace {

constexpr Nanoseconds kFirstWait = std::chrono::milliseconds(250);
constexpr Nanoseconds kLongestWait = std::chrono::seconds(10);
/// Silence on a connection that was dropped without a word looks like a device that is slow: this many time-outs
/// decide.
constexpr int kSilentRequestsBeforeReopen = 3;

ModbusRequest request_for(const ModbusQuantity& quantity) {
  return {.transaction = 0,
          .unit = quantity.slave,
          .function = quantity.function,
          .address = quantity.address,
          .count = static_cast<std::uint16_t>(register_count(quantity.type))};
}

/// The one request that brings both quantities, if there can be one.
std::optional<ModbusRequest> block_request(const ModbusProfile& profile) {
  if (!profile.direction || !profile.block_read) return std::nullopt;
  const ModbusQuantity& speed = profile.speed;
  const ModbusQuantity& direction = *profile.direction;
  if (speed.slave != direction.slave || speed.function != direction.function) return std::nullopt;
  if (speed.read_has_side_effect || direction.read_has_side_effect) return std::nullopt;

  ModbusRequest block = request_for(speed);
  const ModbusRequest other = request_for(direction);
  const bool adjoin = block.address + block.count == other.address || other.address + other.count == block.address;
  if (!adjoin) return std::nullopt;
  block.address = std::min(block.address, other.address);
  block.count = static_cast<std::uint16_t>(block.count + other.count);
  return block;
}

/// The part of an answer to `request` that belongs to `quantity`.
std::span<const std::uint16_t> registers_of(const ModbusQuantity& quantity, const ModbusRequest& request,
                                            const ModbusRegisters& registers) {
  const auto from = static_cast<std::size_t>(quantity.address - request.address);
  return registers.span().subspan(from, register_count(quantity.type));
}

}  // namespace

ModbusSensor::ModbusSensor(ModbusProfile profile, ModbusFraming framing, std::string where, std::uint32_t seed,
                           std::unique_ptr<ModbusConnection> connection)
    : profile_(std::move(profile)),
      framing_(framing),
      where_(std::move(where)),
      connection_(std::move(connection)),
      speed_request_(request_for(profile_.speed)),
      reopen_backoff_(kFirstWait, kLongestWait, seed),
      direction_backoff_(kFirstWait, kLongestWait, seed + 1) {
  if (const auto block = block_request(profile_)) {
    speed_request_ = *block;
  } else if (profile_.direction) {
    direction_request_ = request_for(*profile_.direction);
  }
}

MonoTime ModbusSensor::poll(const Clock& clock, SensorSink& sink) {
  if (clock.now().mono < next_poll_) return next_poll_;
  if (!connection_->is_open()) {
    next_poll_ = open(clock, sink);
  } else {
    next_poll_ = step_ == Step::kSpeed ? ask_speed(clock, sink) : ask_direction(clock, sink);
  }
  return next_poll_;
}

MonoTime ModbusSensor::open(const Clock& clock, SensorSink& sink) {
  const auto opened = connection_->open();
  const MonoTime now = clock.now().mono;
  if (!opened) {
    told_state_ = LinkState::kConnecting;
    told_detail_ = opened.error().message;
    sink.link(told_state_, told_detail_);
    return now + reopen_backoff_.next();
  }
  step_ = Step::kSpeed;
  silent_requests_ = 0;
  believe_from_ = now + profile_.warm_up;
  return now + profile_.delay_after_open;
}

MonoTime ModbusSensor::ask_speed(const Clock& clock, SensorSink& sink) {
  round_start_ = clock.now().mono;
  const Answer answer = ask(speed_request_, sink);
  const Instant now = clock.now();
  if (!answer) {
    tell(sink, LinkState::kConnecting, answer.error().message);
    return next_round(now.mono);
  }

  const auto speed_m_s = decode_speed_m_s(profile_.speed, registers_of(profile_.speed, speed_request_, *answer));
  if (!speed_m_s) {
    sink.refused(speed_m_s.error());
    tell(sink, LinkState::kConnected,
         fmt::format("{} answers, but its speed is {}: check that the profile fits the device",
                     name_of_slave(speed_request_.unit), name_of(speed_m_s.error())));
    return next_round(now.mono);
  }
  reading_ = {.time = now,
              .speed_m_s = *speed_m_s,
              .direction_deg = std::nullopt,
              .gust_m_s = std::nullopt,
              .quality = ReadingQuality::kGood};

  // The direction came along, or will be asked for by the next poll, or there is none for now.
  if (direction_request_ && now.mono >= next_direction_) {
    step_ = Step::kDirection;
    return now.mono + profile_.min_gap;
  }
  if (profile_.direction && !direction_request_) {
    take_direction(registers_of(*profile_.direction, speed_request_, *answer), sink);
  }
  return end_round(now.mono, sink);
}

MonoTime ModbusSensor::ask_direction(const Clock& clock, SensorSink& sink) {
  step_ = Step::kSpeed;
  const Answer answer = ask(*direction_request_, sink);
  const MonoTime now = clock.now().mono;
  if (answer) {
    direction_backoff_.reset();
    take_direction(answer->span(), sink);
  } else {
    direction_trouble_ = answer.error().message;
    next_direction_ = now + direction_backoff_.next();
  }
  return end_round(now, sink);
}

void ModbusSensor::take_direction(std::span<const std::uint16_t> registers, SensorSink& sink) {
  const auto direction_deg = decode_direction_deg(*profile_.direction, registers);
  if (!direction_deg) {
    sink.refused(direction_deg.error());
    direction_trouble_ = fmt::format("its direction is {}", name_of(direction_deg.error()));
    return;
  }
  direction_trouble_.clear();
  const double turned_deg = std::fmod(*direction_deg + profile_.north_offset_deg + 360.0, 360.0);
  reading_.direction_deg = turned_deg;
}

/// Publishes what the round brought.
MonoTime ModbusSensor::end_round(MonoTime now, SensorSink& sink) {
  if (reading_.time.mono < believe_from_) {
    tell(sink, LinkState::kConnected, profile_.name + " at " + where_ + " is warming up");
    return next_round(now);
  }
  const std::string without = direction_trouble_.empty() ? "" : "; without direction: " + direction_trouble_;
  tell(sink, LinkState::kConnected, profile_.name + " at " + where_ + without);
  sink.reading(reading_);
  return next_round(now);
}

MonoTime ModbusSensor::next_round(MonoTime now) {
  if (!connection_->is_open()) return now + reopen_backoff_.next();
  return std::max(round_start_ + profile_.poll_interval, now + profile_.min_gap);
}

ModbusSensor::Answer ModbusSensor::ask(ModbusRequest request, SensorSink& sink) {
  request.transaction = ++transaction_;
  if (!connection_->send(request)) return fail(BusStatus::kLost, request.unit, false, sink);

  // Messages of others, such as the late answer to an earlier request, are passed over until the time is up.
  bool heard_others = false;
  for (;;) {
    const BusMessage message = connection_->receive(buffer_);
    if (message.status != BusStatus::kMessage) return fail(message.status, request.unit, heard_others, sink);
    const auto registers = decode_modbus(framing_, request, std::span(buffer_).first(message.size));
    if (registers || registers.error().why == Refusal::kException) {
      silent_requests_ = 0;
      reopen_backoff_.reset();
    }
    if (registers) return *registers;
    if (registers.error().why != Refusal::kNotMine) return refuse(registers.error(), request.unit, sink);
    sink.refused(Refusal::kNotMine);
    heard_others = true;
  }
}

/// No message came.
Failure ModbusSensor::fail(BusStatus status, std::uint8_t unit, bool heard_others, SensorSink& sink) {
  switch (status) {
    case BusStatus::kSilence:
      if (++silent_requests_ >= kSilentRequestsBeforeReopen) connection_->close();
      if (heard_others) {
        return {name_of_slave(unit) +
                " is not heard, but others are: check its id, and that nobody else asks on its line"};
      }
      sink.refused(Refusal::kTimeout);
      return {fmt::format("{} does not answer within {:g} s: check its power, its wiring and its id",
                          name_of_slave(unit), seconds(profile_.response_timeout))};
    case BusStatus::kCutOff:
      return refuse({Refusal::kTooShort}, unit, sink);
    case BusStatus::kGarbled:
      return refuse({Refusal::kMalformed}, unit, sink);
    case BusStatus::kInterrupted:
      return {"interrupted"};
    case BusStatus::kMessage:
    case BusStatus::kLost:
      break;
  }
  connection_->close();
  return {"the connection to " + where_ + " broke off: opening it again"};
}

/// A message came, and it is no use.
Failure ModbusSensor::refuse(const ModbusRefusal& refusal, std::uint8_t unit, SensorSink& sink) {
  sink.refused(refusal.why);
  if (refusal.why == Refusal::kException) {
    return {fmt::format("{} refuses the request (exception {}, {}): check that the profile fits the device",
                        name_of_slave(unit), refusal.exception, modbus_exception_name(refusal.exception))};
  }
  connection_->resynchronise();
  return {fmt::format(
      "an answer of {} is {}: check wiring and termination, baud rate, parity, and that no other device has its id",
      name_of_slave(unit), name_of(refusal.why))};
}

void ModbusSensor::tell(SensorSink& sink, LinkState state, const std::string& detail) {
  if (state == told_state_ && detail == told_detail_) return;
  told_state_ = state;
  told_detail_ = detail;
  sink.link(state, detail);
}

std::string ModbusSensor::name_of_slave(std::uint8_t unit) const {
  return fmt::format("slave {} at {}", unit, where_);
}

}  // namespace yuragi
