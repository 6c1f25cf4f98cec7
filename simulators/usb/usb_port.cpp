#include "simulators/usb/usb_port.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace yuragi::simulators::usb {
namespace {

/// The faults of every device: of its wind, or of its port.
constexpr std::array kFaultsOfAPort = {core::FaultKind::kSilence, core::FaultKind::kFreeze, core::FaultKind::kSpike,
                                       core::FaultKind::kUnplug};

/// The most transfers that a host may have pending; a kernel has a few.
constexpr std::size_t kMaxWaiting = 1024;

/// The most messages that are read and dropped at once: a device that always has data would never be empty.
constexpr int kMaxLost = 1000;

}  // namespace

Port::Port(std::unique_ptr<Device> device, core::MeasuredWind wind)
    : device_(std::move(device)),
      control_pipe_(*device_),
      summary_(summary_of(device_->descriptors())),
      known_faults_(kFaultsOfAPort.begin(), kFaultsOfAPort.end()),
      wind_(std::move(wind)) {
  const auto own = device_->known_faults();
  device_faults_.assign(own.begin(), own.end());
  for (const core::FaultKind kind : own) {
    if (std::ranges::count(known_faults_, kind) == 0) known_faults_.push_back(kind);
  }
}

void Port::advance(double time_s, std::optional<core::FaultKind> fault) {
  moment_ = wind_.at(time_s, fault);
  const bool was_plugged_in = std::exchange(is_plugged_in_, fault != core::FaultKind::kUnplug);
  is_silent_ = fault == core::FaultKind::kSilence;
  if (!is_plugged_in_) waiting_.clear();
  const bool is_the_devices = fault && std::ranges::count(device_faults_, *fault) != 0;
  device_->advance(time_s, moment_, is_the_devices ? fault : std::nullopt);
  if (!was_plugged_in) lose_what_waits();
}

void Port::lose_what_waits() {
  for (const Endpoint& endpoint : summary_.endpoints) {
    if ((endpoint.address & 0x80U) == 0) continue;
    for (int i = 0; i < kMaxLost; ++i) {
      if (!device_->in(endpoint.address & 0x0FU, endpoint.max_packet_size)) break;
    }
  }
}

void Port::submit(Transfer transfer) {
  if (is_plugged_in_ && waiting_.size() < kMaxWaiting) waiting_.push_back(std::move(transfer));
}

bool Port::cancel(std::uint64_t id) {
  return std::erase_if(waiting_, [id](const Transfer& transfer) { return transfer.id == id; }) != 0;
}

void Port::cancel_all() {
  waiting_.clear();
}

std::vector<Outcome> Port::take_outcomes() {
  std::vector<Outcome> outcomes;
  std::array<bool, 256> is_busy{};  // by end point address: a waiting transfer keeps those after it waiting
  for (auto transfer = waiting_.begin(); transfer != waiting_.end();) {
    bool& busy = is_busy[transfer->endpoint | (transfer->is_to_host && transfer->endpoint != 0 ? 0x80U : 0U)];
    std::optional<Outcome> outcome = busy ? std::nullopt : attempt(*transfer);
    if (outcome) {
      outcomes.push_back(std::move(*outcome));
      transfer = waiting_.erase(transfer);
    } else {
      busy = true;
      ++transfer;
    }
  }
  if (is_silent_) lose_what_waits();
  return outcomes;
}

std::optional<Outcome> Port::attempt(const Transfer& transfer) {
  Outcome outcome;
  outcome.id = transfer.id;
  const auto give = [&](std::optional<Bytes> data) {
    outcome.is_refused = !data;
    if (data) outcome.data = std::move(*data);
    outcome.size = outcome.data.size();
  };

  if (transfer.endpoint == 0) {
    const bool gets_reply = !is_silent_ || !transfer.setup.is_to_host() || ControlPipe::is_standard(transfer.setup);
    if (!gets_reply) return std::nullopt;
    give(control_pipe_.control(transfer.setup, transfer.data));
    if (!outcome.is_refused && !transfer.setup.is_to_host()) outcome.size = transfer.data.size();
  } else if (transfer.is_to_host) {
    if (summary_.endpoint(transfer.endpoint | 0x80U) == nullptr) {
      outcome.is_refused = true;
      return outcome;
    }
    std::optional<Bytes> data = is_silent_ ? std::nullopt : device_->in(transfer.endpoint, transfer.max_size);
    if (!data) return std::nullopt;
    if (data->size() > transfer.max_size) data->resize(transfer.max_size);
    give(std::move(data));
  } else {
    outcome.is_refused =
        summary_.endpoint(transfer.endpoint) == nullptr || !device_->out(transfer.endpoint, transfer.data);
    outcome.size = outcome.is_refused ? 0 : transfer.data.size();
  }
  return outcome;
}

}  // namespace yuragi::simulators::usb
