#include "simulators/text/text_simulator.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace yuragi::simulators::text {
namespace {

constexpr std::size_t kTextGarbageBytes = 24;
constexpr std::size_t kPieces = 3;
constexpr double kPieceGap_s = 0.03;
/// The delay of a late reply: longer than a client should wait.
constexpr double kLate_s = 1.3;
constexpr std::size_t kMaxRequest = 256;

}  // namespace

Simulator::Simulator(std::unique_ptr<Device> device, std::unique_ptr<Wire> wire, double rate_hz,
                     core::MeasuredWind wind, std::uint64_t seed)
    : device_(std::move(device)),
      wire_(std::move(wire)),
      rate_hz_(rate_hz),
      wind_(std::move(wind)),
      random_(seed),
      known_faults_{core::FaultKind::kSilence, core::FaultKind::kFreeze, core::FaultKind::kSpike,
                    core::FaultKind::kGarbage, core::FaultKind::kSplit,  core::FaultKind::kPartial} {
  const auto add = [this](std::span<const core::FaultKind> more) {
    known_faults_.insert(known_faults_.end(), more.begin(), more.end());
  };
  add(device_->known_faults());
  if (rate_hz_ <= 0.0) known_faults_.push_back(core::FaultKind::kLate);
  add(wire_->known_faults());
  wire_->greet_with(device_->greeting());
  if (device_->waits_for_clients()) wire_->wait_for_clients();
}

void Simulator::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  fault_ = fault;
  if (fault == core::FaultKind::kDisconnect || fault == core::FaultKind::kUnplug) {
    wire_->take_away();
    waiting_.clear();
    request_.clear();
    next_s_ = time_s;
    return;
  }
  wire_->bring_back();
  wire_->refuse(fault == core::FaultKind::kException);

  receive(wire_->read(ready), time_s, fault);
  while (!waiting_.empty() && waiting_.front().time_s <= time_s) {
    wire_->write(waiting_.front().bytes);
    waiting_.pop_front();
  }
  for (; rate_hz_ > 0.0 && next_s_ <= time_s; next_s_ += 1.0 / rate_hz_) send_messages(next_s_, fault);
}

void Simulator::receive(std::string_view bytes, double time_s, std::optional<core::FaultKind> fault) {
  for (const char c : bytes) {
    if (c != '\r' && c != '\n') {
      if (request_.size() < kMaxRequest) request_ += c;
      continue;
    }
    const std::string request = std::exchange(request_, "");
    device_->hear(request);
    if (!request.empty() && device_->is_request(request)) send_messages(time_s, fault);
  }
}

void Simulator::send_messages(double time_s, std::optional<core::FaultKind> fault) {
  moment_ = wind_.at(time_s, fault);
  if (fault == core::FaultKind::kSilence) return;
  for (const std::string& message : device_->send_messages(moment_, fault)) send(message, time_s, fault);
  ++sent_;
}

void Simulator::send(const std::string& message, double time_s, std::optional<core::FaultKind> fault) {
  if (fault == core::FaultKind::kGarbage) {
    std::string noise(kTextGarbageBytes, '\0');
    std::ranges::generate(noise, [this] { return static_cast<char>(random_()); });
    return send_after(0.0, noise, time_s);
  }
  if (fault == core::FaultKind::kPartial) return send_after(0.0, message.substr(0, message.size() * 2 / 3), time_s);
  if (fault == core::FaultKind::kLate) return send_after(kLate_s, message, time_s);
  if (fault == core::FaultKind::kSplit) {
    const std::size_t size = message.size() / kPieces + 1;
    for (std::size_t piece = 0; piece * size < message.size(); ++piece) {
      send_after(static_cast<double>(piece) * kPieceGap_s, message.substr(piece * size, size), time_s);
    }
    return;
  }
  send_after(0.0, message, time_s);
}

/// Sends at once if there is no delay, unless something waits: bytes keep their order.
void Simulator::send_after(double delay_s, const std::string& bytes, double time_s) {
  if (delay_s == 0.0 && waiting_.empty()) return wire_->write(bytes);
  const double due_s = time_s + delay_s;
  waiting_.push_back({waiting_.empty() ? due_s : std::max(due_s, waiting_.back().time_s), bytes});
}

std::string Simulator::status() const {
  return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}, {} sent{}{}", moment_.speed_m_s, moment_.direction_deg,
                     wire_->place(), sent_, fault_ ? ", fault: " : "", fault_ ? name_of(*fault_) : "");
}

}  // namespace yuragi::simulators::text
