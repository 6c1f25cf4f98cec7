#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <poll.h>
#include <sys/eventfd.h>

#include "simulators/simulator.hpp"
#include "tests/support/descriptor.hpp"

namespace yuragi {

/// Runs a simulator on a thread of its own, in real time or faster, with whatever fault the test says.
class SimulatorThread {
 public:
  /// `pace`: how many seconds pass for the simulator in each real one. `simulator` is used on the thread alone.
  explicit SimulatorThread(std::unique_ptr<sim::Simulator> simulator, double pace = 1.0)
      : simulator_(std::move(simulator)), pace_(pace), thread_([this] { run(); }) {}
  ~SimulatorThread() {
    is_wanted_ = false;
    eventfd_write(wake_.get(), 1);
    thread_.join();
  }
  SimulatorThread(const SimulatorThread&) = delete;
  SimulatorThread& operator=(const SimulatorThread&) = delete;

  void set_fault(std::optional<sim::FaultKind> fault) {
    fault_ = fault ? static_cast<int>(*fault) : kNone;
    eventfd_write(wake_.get(), 1);
  }

 private:
  static constexpr int kNone = -1;
  static constexpr int kTurn_ms = 5;

  void run() {
    const auto start = std::chrono::steady_clock::now();
    std::vector<pollfd> waits;
    std::vector<int> ready;
    while (is_wanted_) {
      waits = {{wake_.get(), POLLIN, 0}};
      for (const int descriptor : simulator_->descriptors()) waits.push_back({descriptor, POLLIN, 0});
      poll(waits.data(), waits.size(), kTurn_ms);
      eventfd_t ignored = 0;
      if (waits[0].revents != 0) eventfd_read(wake_.get(), &ignored);
      ready.clear();
      for (const pollfd& wait : waits) {
        if (wait.revents != 0) ready.push_back(wait.fd);
      }
      const double time_s = pace_ * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const int fault = fault_;
      simulator_->serve(ready, time_s,
                        fault == kNone ? std::nullopt : std::optional(static_cast<sim::FaultKind>(fault)));
    }
    simulator_.reset();
  }

  std::unique_ptr<sim::Simulator> simulator_;
  double pace_;
  std::atomic<int> fault_ = kNone;
  std::atomic<bool> is_wanted_ = true;
  Descriptor wake_{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  std::thread thread_;
};

}  // namespace yuragi
