#include "simulators/modbus/modbus_simulator.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

#include "engine/base/count_text.hpp"

namespace yuragi::simulators::modbus {
namespace {

constexpr double kWindow_s = 3.0;         // of gust, lull and mean
constexpr double kPauseOfSplit_s = 0.03;  // between the pieces of a reply
constexpr std::size_t kMaxRegisters = 125;
constexpr std::size_t kGarbageBytes = 24;

/// The speeds of the last seconds.
class SpeedWindow {
 public:
  void add(double time_s, double speed_m_s) {
    while (!speeds_.empty() && speeds_.front().first < time_s - kWindow_s) speeds_.pop_front();
    speeds_.emplace_back(time_s, speed_m_s);
  }
  void clear() { speeds_.erase(speeds_.begin(), speeds_.empty() ? speeds_.end() : std::prev(speeds_.end())); }

  /// Gust, lull and mean of these speeds; at least one must have been added.
  Air air(double direction_deg) const {
    Air air{.speed_m_s = speeds_.back().second,
            .direction_deg = direction_deg,
            .gust_m_s = speeds_.back().second,
            .lull_m_s = speeds_.back().second,
            .mean_m_s = 0.0};
    for (const auto& [time_s, speed_m_s] : speeds_) {
      air.gust_m_s = std::max(air.gust_m_s, speed_m_s);
      air.lull_m_s = std::min(air.lull_m_s, speed_m_s);
      air.mean_m_s += speed_m_s / static_cast<double>(speeds_.size());
    }
    return air;
  }

 private:
  std::deque<std::pair<double, double>> speeds_;
};

/// One device on the simulated line.
struct SimulatedSlave {
  Slave model;
  SpeedWindow window;
  RegisterBank registers;
};

/// Bytes that are to be sent later.
struct DueMessage {
  double due_s;
  int client;
  Bytes bytes;
};

}  // namespace

class Simulator::State {
 public:
  State(std::unique_ptr<Port> port, core::MeasuredWind wind, const FaultOptions& options)
      : port_(std::move(port)), wind_(std::move(wind)), options_(options), random_(options.seed) {}

  void add(const Slave& slave) {
    if (slave_of(slave.id) != nullptr) {
      throw std::runtime_error(
          fmt::format("two devices have the id {}: give one of them another id, as NAME@ID", slave.id));
    }
    slaves_.push_back({slave, {}, {}});
  }

  const Port& port() const { return *port_; }

  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
    // The devices go on measuring between requests.
    now_s_ = time_s;
    fault_ = fault;
    moment_ = wind_.at(time_s, fault);
    for (SimulatedSlave& slave : slaves_) {
      slave.window.add(time_s, moment_.speed_m_s);
      slave.model.measure(slave.window.air(moment_.direction_deg), slave.registers);
    }

    // Unplugged or disconnected: no request is served until the port is open again.
    if (fault == core::FaultKind::kDisconnect || fault == core::FaultKind::kUnplug) {
      outgoing_.clear();
      return port_->leave();
    }
    port_->come_back();

    for (const Port::ClientRequest& received : port_->receive(ready)) reply(received);
    send_what_is_due();
  }

  std::string status() const {
    return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}{}{}", moment_.speed_m_s, moment_.direction_deg,
                       count_text(replied_, "response"), fault_ ? ", fault: " : "", fault_ ? name_of(*fault_) : "");
  }

 private:
  SimulatedSlave* slave_of(std::uint8_t id) {
    const auto found = std::ranges::find(slaves_, id, [](const SimulatedSlave& slave) { return slave.model.id; });
    return found != slaves_.end() ? &*found : nullptr;
  }

  /// The reply of a device without a fault; reading a clearing register clears.
  static Bytes right_reply(SimulatedSlave& slave, const SlaveRequest& request) {
    if (request.function != slave.model.function) return exception_reply(request.function, kIllegalFunction);
    if (request.count < 1 || request.count > kMaxRegisters) {
      return exception_reply(request.function, kIllegalValue);
    }
    std::vector<std::uint16_t> values;
    for (unsigned i = 0; i < request.count; ++i) {
      const auto value = slave.registers.at(static_cast<std::uint16_t>(request.address + i));
      if (!value) return exception_reply(request.function, kIllegalAddress);
      values.push_back(*value);
    }
    const std::uint16_t clearing = slave.model.clearing_register;
    if (clearing >= request.address && clearing < request.address + request.count) slave.window.clear();
    return registers_reply(request.function, values);
  }

  void reply(const Port::ClientRequest& received) {
    // If no slave has that id, a gateway reports it, and a serial line stays silent.
    const SlaveRequest& request = received.request;
    SimulatedSlave* const slave = slave_of(request.unit);
    if (slave == nullptr) {
      if (!port_->is_rtu()) send(received, exception_reply(request.function, kGatewayTargetSilent), 0.0);
      return;
    }
    const bool is_well = !fault_ || (options_.id && *options_.id != request.unit);
    ++replied_;
    if (is_well) return send(received, right_reply(*slave, request), 0.0);
    reply_wrongly(received, right_reply(*slave, request));
  }

  void reply_wrongly(Port::ClientRequest received, const Bytes& right) {
    switch (*fault_) {
      case core::FaultKind::kSilence:
        return;
      case core::FaultKind::kLate:
        return send(received, right, options_.late_s);
      case core::FaultKind::kException:
        return send(received, exception_reply(received.request.function, kDeviceFailure), 0.0);
      case core::FaultKind::kWrongTransaction:
        --received.request.transaction;
        return send(received, right, 0.0);
      case core::FaultKind::kWrongId:
        ++received.request.unit;
        return send(received, right, 0.0);
      case core::FaultKind::kGarbage:
      case core::FaultKind::kSplit:
      case core::FaultKind::kPartial:
      case core::FaultKind::kBadChecksum:
        return send_damaged(received.client, message(received.request, right));
      case core::FaultKind::kFreeze:
      case core::FaultKind::kSpike:
      case core::FaultKind::kDisconnect:
      case core::FaultKind::kUnplug:
        return send(received, right, 0.0);
    }
  }

  void send_damaged(int client, Bytes bytes) {
    if (fault_ == core::FaultKind::kSplit) {
      // A byte, then some, then the rest.
      const auto first = bytes.begin() + 1;
      const auto second = bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2 + 1);
      queue(client, {bytes.begin(), first}, 0.0);
      queue(client, {first, second}, kPauseOfSplit_s);
      queue(client, {second, bytes.end()}, 2 * kPauseOfSplit_s);
      return;
    }
    if (fault_ == core::FaultKind::kGarbage) {
      bytes.resize(kGarbageBytes);
      std::ranges::generate(bytes, [this] { return static_cast<std::uint8_t>(random_()); });
    } else if (fault_ == core::FaultKind::kPartial) {
      bytes.pop_back();
    } else {
      bytes.back() ^= 0xFFU;
    }
    queue(client, std::move(bytes), 0.0);
  }

  Bytes message(const SlaveRequest& request, const Bytes& reply) const {
    return port_->is_rtu() ? rtu_message(request.unit, reply) : tcp_message(request.transaction, request.unit, reply);
  }

  void send(const Port::ClientRequest& received, const Bytes& reply, double delay_s) {
    queue(received.client, message(received.request, reply), delay_s);
  }

  void queue(int client, Bytes bytes, double delay_s) {
    outgoing_.push_back({now_s_ + delay_s, client, std::move(bytes)});
  }

  void send_what_is_due() {
    for (const DueMessage& out : outgoing_) {
      if (out.due_s <= now_s_) port_->send(out.client, out.bytes);
    }
    std::erase_if(outgoing_, [this](const DueMessage& out) { return out.due_s <= now_s_; });
  }

  std::unique_ptr<Port> port_;
  core::MeasuredWind wind_;
  FaultOptions options_;
  std::mt19937_64 random_;
  std::vector<SimulatedSlave> slaves_;
  std::vector<DueMessage> outgoing_;

  double now_s_ = 0.0;
  core::PlayedMoment moment_;
  std::optional<core::FaultKind> fault_;
  std::uint64_t replied_ = 0;
};

Simulator::Simulator(const std::vector<Slave>& slaves, std::unique_ptr<Port> port, core::MeasuredWind wind,
                     const FaultOptions& options)
    : state_(std::make_unique<State>(std::move(port), std::move(wind), options)) {
  for (const Slave& slave : slaves) state_->add(slave);
}

Simulator::~Simulator() = default;

std::string Simulator::name() const {
  return state_->port().name();
}

std::span<const core::FaultKind> Simulator::known_faults() const {
  using enum core::FaultKind;
  static constexpr std::array kOverTcp = {kSilence, kFreeze,           kSpike, kGarbage,   kSplit,     kPartial,
                                          kWrongId, kWrongTransaction, kLate,  kException, kDisconnect};
  static constexpr std::array kOverRtu = {kSilence,     kFreeze,  kSpike, kGarbage,   kSplit, kPartial,
                                          kBadChecksum, kWrongId, kLate,  kException, kUnplug};
  if (state_->port().is_rtu()) return kOverRtu;
  return kOverTcp;
}

std::vector<int> Simulator::descriptors() const {
  return state_->port().descriptors();
}

void Simulator::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  state_->serve(ready, time_s, fault);
}

std::string Simulator::status() const {
  return state_->status();
}

}  // namespace yuragi::simulators::modbus
