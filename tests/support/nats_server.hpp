#pragma once

#include <csignal>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/child_process.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi {

/// Debian's nats-server on the loopback, which a test can kill, hold up and start again at the same port.
class NatsServer {
 public:
  /// `more`: further lines of its configuration. `is_running`: starts it.
  explicit NatsServer(std::string more = "", bool is_running = true)
      : port_(free_port(SOCK_STREAM)), more_(std::move(more)) {
    if (is_running) start();
  }

  std::uint16_t port() const { return port_; }
  std::string address(const std::string& scheme = "nats", const std::string& host = "127.0.0.1") const {
    return scheme + "://" + host + ":" + std::to_string(port_);
  }

  void start() {
    const auto file = folder_ / "nats.conf";
    std::ofstream(file) << "host: 127.0.0.1\nport: " << port_ << "\nlogtime: false\n" << more_;
    process_.emplace(std::vector<std::string>{"nats-server", "-c", file.string()});
    // "[PID] [INF] Server is ready"
    while (process_->line_after("[").find("Server is ready") == std::string::npos) continue;
  }
  void kill() { process_.reset(); }  // SIGKILL
  /// It hangs: connections stay, and nothing is sent on them.
  void hold() const { process_->send(SIGSTOP); }
  void go_on() const { process_->send(SIGCONT); }

 private:
  test::TemporaryFolder folder_;
  std::uint16_t port_;
  std::string more_;
  std::optional<ChildProcess> process_;
};

/// Two servers of one cluster.
struct NatsPair {
  std::uint16_t first_route = free_port(SOCK_STREAM), second_route = free_port(SOCK_STREAM);
  NatsServer first{cluster(first_route, second_route)}, second{cluster(second_route, first_route)};

  static std::string cluster(std::uint16_t own, std::uint16_t other) {
    return "cluster { name: y, listen: \"127.0.0.1:" + std::to_string(own) +
           "\", routes: [\"nats://127.0.0.1:" + std::to_string(other) + "\"] }\n";
  }
};

}  // namespace yuragi
