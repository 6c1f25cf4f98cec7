#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "simulators/core/line_reader.hpp"
#include "simulators/core/simulator.hpp"

namespace yuragi::simulators::core {
namespace {

constexpr int kTurn_ms = 20;

/// SIGINT and SIGTERM as a readable descriptor, for the lifetime of this object.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    descriptor_ = signalfd(-1, &signals_, SFD_CLOEXEC | SFD_NONBLOCK);
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
  }
  ~StopSignals() {
    // A signal that has arrived must not end the program when the mask is restored.
    signalfd_siginfo taken{};
    while (read(descriptor_, &taken, sizeof taken) > 0) {
    }
    close(descriptor_);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  sigset_t signals_{};
  sigset_t before_{};
  int descriptor_ = -1;
};

/// Standard input. A simulator in the background of a terminal gets an error when it reads, and is not stopped.
LineReader typed_lines() {
  std::signal(SIGTTIN, SIG_IGN);
  return LineReader(STDIN_FILENO);
}

}  // namespace

void run(Simulator& simulator, Faults faults, const RunOptions& options) {
  using Clock = std::chrono::steady_clock;
  const StopSignals stop;
  LineReader typed = typed_lines();
  const bool shows_status = options.verbose || isatty(STDERR_FILENO) == 1;
  const auto start = Clock::now();
  double next_status_s = 1.0;

  std::vector<pollfd> waits;
  std::vector<int> ready;
  for (;;) {
    // Wait for a signal, a line or work.
    waits.clear();
    waits.push_back({stop.descriptor(), POLLIN, 0});
    waits.push_back({typed.is_open() ? STDIN_FILENO : -1, POLLIN, 0});
    for (const int descriptor : simulator.descriptors()) waits.push_back({descriptor, POLLIN, 0});
    if (poll(waits.data(), waits.size(), kTurn_ms) < 0 && errno != EINTR) {
      throw std::system_error(errno, std::generic_category(), "poll");
    }
    const double time_s = std::chrono::duration<double>(Clock::now() - start).count();
    if (waits[0].revents != 0 || (options.duration_s && time_s >= *options.duration_s)) return;
    if (waits[1].revents != 0) {
      typed.read_lines([&](const std::string& line) {
        if (simulator.take_line(line)) return;
        if (const std::string reply = faults.obey(line, time_s); !reply.empty()) {
          std::fprintf(stderr, "%s\n", reply.c_str());
        }
      });
    }

    ready.clear();
    for (const pollfd& wait : std::span(waits).subspan(2)) {
      if (wait.revents != 0) ready.push_back(wait.fd);
    }
    simulator.serve(ready, time_s, faults.at(time_s));
    if (simulator.is_over()) return;

    if (shows_status && time_s >= next_status_s) {
      next_status_s = time_s + 1.0;
      std::fprintf(stderr, "%6.0f s  %s\n", time_s, simulator.status().c_str());
    }
  }
}

}  // namespace yuragi::simulators::core
