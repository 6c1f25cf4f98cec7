#include "drivers/modbus/modbus_bus.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "drivers/sensor/driver.hpp"

namespace yuragi::drivers::modbus {
namespace {

/// A connection that was dropped silently looks like a slow device: after this many requests in a row without a reply
/// it is assumed lost.
constexpr int kSilentRequestsBeforeReopen = 3;

Trouble trouble(Trouble::Kind kind) {
  return {kind, {}};
}

void show_sent(decode::modbus::Framing framing, const decode::modbus::Request& request, sensor::Sink& sink) {
  if (framing == decode::modbus::Framing::kTcp) {
    sink.raw(sensor::RawDirection::kSent, decode::modbus::encode_tcp(request));
  } else {
    sink.raw(sensor::RawDirection::kSent, decode::modbus::encode_rtu(request));
  }
}

/// "9600 8N1".
std::string settings_of(const bus::ModbusLine& line) {
  return fmt::format("{} 8{}{}", line.baud, line.parity, line.stop_bits);
}

/// The key of a line: the same for all its names.
std::string address_of(const bus::ModbusLine& line) {
  if (line.framing == decode::modbus::Framing::kTcp) return describe(line);
  std::error_code ignored;
  const auto port = std::filesystem::canonical(line.device, ignored);
  return ignored ? line.device : port.string();
}

}  // namespace

/// A place in the queue: taken at its end, and left when this object is destroyed. The first in the queue has the line.
class Bus::Turn {
 public:
  Turn(Bus& bus, const bus::Interruption& interruption) : bus_(bus) {
    std::unique_lock lock(bus_.mutex_);
    ticket_ = ++bus_.last_ticket_;
    bus_.waiting_.push_back(ticket_);
    bus_.turn_ended_.wait(lock, [&] { return is_first() || interruption.is_set(); });
    has_line_ = is_first() && !interruption.is_set();
  }
  ~Turn() {
    const std::lock_guard lock(bus_.mutex_);
    std::erase(bus_.waiting_, ticket_);
    bus_.turn_ended_.notify_all();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  /// Returns false if `interruption` was set first.
  bool has_line() const noexcept { return has_line_; }

  /// Waits for the rest of the gap. Returns false if `interruption` was set first.
  bool wait_for_gap(const bus::Interruption& interruption, MonoTime now) {
    std::unique_lock lock(bus_.mutex_);
    if (now >= bus_.free_at_) return true;
    return !bus_.turn_ended_.wait_for(lock, bus_.free_at_ - now, [&interruption] { return interruption.is_set(); });
  }

  /// The exchange is over.
  void begin_gap(MonoTime now) {
    const std::lock_guard lock(bus_.mutex_);
    bus_.free_at_ = now + bus_.min_gap_;
  }

  /// A reply of `unit` may still come until then.
  void expect_late_reply(std::uint8_t unit, MonoTime until) {
    const std::lock_guard lock(bus_.mutex_);
    bus_.unit_ready_at_[unit] = until;
  }

 private:
  bool is_first() const { return bus_.waiting_.front() == ticket_; }

  Bus& bus_;
  std::uint64_t ticket_ = 0;
  bool has_line_ = false;
};

Bus::Bus(const bus::ModbusLine& line, std::unique_ptr<bus::ModbusConnection> connection)
    : line_(line), where_(describe(line)), min_gap_(bus::frame_gap(line)), connection_(std::move(connection)) {}

Result<void, Failure> Bus::suits(const bus::ModbusLine& line) const {
  const bool is_same = line.baud == line_.baud && line.parity == line_.parity && line.stop_bits == line_.stop_bits;
  if (line.framing == decode::modbus::Framing::kTcp || is_same) return {};
  return Failure{
      fmt::format("{} is used with {} by another sensor, and cannot have {} at the same time: give both the "
                  "same baud, parity and stop_bits",
                  where_, settings_of(line_), settings_of(line))};
}

void Bus::keep_gap(Nanoseconds min_gap) {
  const std::lock_guard lock(mutex_);
  min_gap_ = std::max(min_gap_, min_gap);
}

Result<MonoTime, Failure> Bus::open(const bus::Interruption& interruption, const sensor::Clock& clock) {
  // Usually it is open, and this returns without waiting for the line.
  const auto open_since = [this] {
    const std::lock_guard lock(mutex_);
    return open_since_;
  };
  if (const auto since = open_since()) return *since;

  const Turn turn(*this, interruption);
  if (!turn.has_line()) return Failure{"interrupted"};
  if (const auto since = open_since()) return *since;
  if (const auto opened = connection_->open(interruption); !opened) return opened.error();
  is_unsettled_ = true;
  silent_requests_ = 0;
  const std::lock_guard lock(mutex_);
  open_since_ = clock.now().mono;
  return *open_since_;
}

MonoTime Bus::ready_at(std::uint8_t unit) const {
  const std::lock_guard lock(mutex_);
  return unit_ready_at_[unit];
}

Bus::Reply Bus::exchange(decode::modbus::Request request, const bus::ModbusPatience& patience,
                         const bus::Interruption& interruption, const sensor::Clock& clock, sensor::Sink& sink) {
  using enum Trouble::Kind;
  Turn turn(*this, interruption);
  if (!turn.has_line() || !turn.wait_for_gap(interruption, clock.now().mono)) return trouble(kInterrupted);

  request.transaction = ++transaction_;
  const Reply reply = transact(request, patience, interruption, sink);

  // A request without a reply may still get one.
  const MonoTime now = clock.now().mono;
  turn.begin_gap(now);
  const bool may_come_late = !reply && (reply.error().kind == kSilence || reply.error().kind == kOthersOnly ||
                                        reply.error().refusal.why == decode::Refusal::kTooShort);
  if (may_come_late && line_.framing == decode::modbus::Framing::kRtu) {
    turn.expect_late_reply(request.unit, now + patience.response_timeout);
  }
  return reply;
}

std::size_t Bus::waiting_count() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size();
}

void Bus::wake_waiters() noexcept {
  const std::lock_guard lock(mutex_);
  turn_ended_.notify_all();
}

void Bus::close_line() noexcept {
  connection_->close();
  const std::lock_guard lock(mutex_);
  open_since_.reset();
}

Bus::Reply Bus::transact(const decode::modbus::Request& request, const bus::ModbusPatience& patience,
                         const bus::Interruption& interruption, sensor::Sink& sink) {
  if (is_unsettled_) {
    const std::size_t leftover = connection_->settle(buffer_, patience, interruption);
    const auto bytes = std::span(buffer_).first(leftover);
    if (leftover > 0) sink.raw(sensor::RawDirection::kReceived, bytes);
    // Usually a late reply; noise has been counted when it was taken for a reply.
    if (leftover > 0 && decode::modbus::modbus_crc(bytes) == 0) sink.refused(decode::Refusal::kNotMine);
  }
  is_unsettled_ = true;
  if (!connection_->send(request, patience)) return fail(bus::Status::kLost, false, sink);
  show_sent(line_.framing, request, sink);

  // Messages of others, such as the late reply to an earlier request, are skipped until the time-out.
  bool received_others = false;
  for (;;) {
    const bus::Message message = connection_->receive(buffer_, interruption);
    if (message.status != bus::Status::kMessage) return fail(message.status, received_others, sink);
    const auto bytes = std::span(buffer_).first(message.size);
    sink.raw(sensor::RawDirection::kReceived, bytes);

    const auto registers = decode::modbus::decode_modbus(line_.framing, request, bytes);
    if (registers || registers.error().why == decode::Refusal::kException) {
      silent_requests_ = 0;
      is_unsettled_ = received_others;
    }
    if (registers) return *registers;
    if (registers.error().why != decode::Refusal::kNotMine) return refuse(registers.error(), sink);
    sink.refused(decode::Refusal::kNotMine);
    received_others = true;
  }
}

/// No message came.
Trouble Bus::fail(bus::Status status, bool received_others, sensor::Sink& sink) {
  using enum Trouble::Kind;
  switch (status) {
    case bus::Status::kSilence:
      if (++silent_requests_ >= kSilentRequestsBeforeReopen) close_line();
      if (received_others) return trouble(kOthersOnly);
      sink.refused(decode::Refusal::kTimeout);
      return trouble(kSilence);
    case bus::Status::kCutOff:
      return refuse({decode::Refusal::kTooShort}, sink);
    case bus::Status::kGarbled:
      return refuse({decode::Refusal::kMalformed}, sink);
    case bus::Status::kInterrupted:
      return trouble(kInterrupted);
    case bus::Status::kMessage:
    case bus::Status::kLost:
      break;
  }
  close_line();
  return trouble(kLost);
}

/// A message came and was refused. Where one TCP message ends and the next begins is not known any more.
Trouble Bus::refuse(const decode::modbus::RefusedReply& refusal, sensor::Sink& sink) {
  sink.refused(refusal.why);
  if (refusal.why != decode::Refusal::kException && line_.framing == decode::modbus::Framing::kTcp) close_line();
  return {Trouble::Kind::kRefused, refusal};
}

std::shared_ptr<Bus> shared_modbus_bus(const bus::ModbusLine& line) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<Bus>> buses;

  const std::lock_guard lock(mutex);
  std::erase_if(buses, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<Bus>& known = buses[address_of(line)];
  std::shared_ptr<Bus> bus = known.lock();
  if (bus) {
    if (const auto suits = bus->suits(line); !suits) throw sensor::LineInUse(suits.error().message);
    return bus;
  }
  bus = std::make_shared<Bus>(line, bus::make_modbus_connection(line));
  known = bus;
  return bus;
}

}  // namespace yuragi::drivers::modbus
