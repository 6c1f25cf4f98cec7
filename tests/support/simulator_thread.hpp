#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <poll.h>
#include <sys/eventfd.h>

#include "simulators/core/simulator.hpp"
#include "tests/support/descriptor.hpp"

namespace yuragi {

/// Runs a simulator on a thread of its own, in real time or faster, with whatever fault the test says.
class SimulatorThread {
 public:
  /// `pace`: how many seconds pass for the simulator in each real one. `simulator` is used on the thread alone.
  explicit SimulatorThread(std::unique_ptr<simulators::core::Simulator> simulator, double pace = 1.0)
      : simulator_(std::move(simulator)), pace_(pace), thread_([this] { run(); }) {}
  ~SimulatorThread() {
    is_wanted_ = false;
    eventfd_write(wake_.get(), 1);
    thread_.join();
  }
  SimulatorThread(const SimulatorThread&) = delete;
  SimulatorThread& operator=(const SimulatorThread&) = delete;

  /// Comes back when the simulator has done what the fault, or the end of one, makes it do.
  void set_fault(std::optional<simulators::core::FaultKind> fault) {
    std::unique_lock lock(mutex_);
    fault_ = fault;
    const std::uint64_t wanted = ++set_;
    eventfd_write(wake_.get(), 1);
    served_changed_.wait(lock, [&] { return served_ >= wanted; });
  }

 private:
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
      std::unique_lock lock(mutex_);
      const auto fault = fault_;
      const std::uint64_t set = set_;
      lock.unlock();
      simulator_->serve(ready, time_s, fault);
      lock.lock();
      served_ = set;
      lock.unlock();
      served_changed_.notify_all();
    }
    simulator_.reset();
  }

  std::unique_ptr<simulators::core::Simulator> simulator_;
  double pace_;
  std::mutex mutex_;
  std::condition_variable served_changed_;
  std::optional<simulators::core::FaultKind> fault_;
  std::uint64_t set_ = 0;     ///< how often the fault was set
  std::uint64_t served_ = 0;  ///< the one of them that it has served with
  std::atomic<bool> is_wanted_ = true;
  Descriptor wake_{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  std::thread thread_;
};

}  // namespace yuragi
