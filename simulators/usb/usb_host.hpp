#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "simulators/usb/usb_port.hpp"

namespace yuragi::simulators::usb {

/// The host's end of a port, for several users of one device: each transfer is submitted with a function that takes its
/// outcome. Thread-safe: no.
class Host {
 public:
  using Then = std::function<void(const Outcome&)>;

  /// `port` must outlive this.
  explicit Host(Port& port) : port_(port) {}

  Port& port() const noexcept { return port_; }

  /// Sets and returns `transfer.id`.
  std::uint64_t submit(Transfer transfer, Then then) {
    transfer.id = ++last_id_;
    waiting_.emplace(transfer.id, std::move(then));
    port_.submit(std::move(transfer));
    return last_id_;
  }

  /// Drops a transfer that waits, without calling its function. Returns false if it is not waiting.
  bool cancel(std::uint64_t id) {
    port_.cancel(id);
    return waiting_.erase(id) != 0;
  }

  void cancel_all() {
    port_.cancel_all();
    waiting_.clear();
  }

  /// Calls the functions of the transfers that have completed; these may submit others.
  void serve() {
    for (int round = 0; round < kMaxRounds; ++round) {
      const auto outcomes = port_.take_outcomes();
      if (outcomes.empty()) return;
      for (const Outcome& outcome : outcomes) {
        if (auto found = waiting_.extract(outcome.id)) found.mapped()(outcome);
      }
    }
  }

 private:
  static constexpr int kMaxRounds = 64;  // a device that always has data must not keep the others waiting

  Port& port_;
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, Then> waiting_;
};

}  // namespace yuragi::simulators::usb
