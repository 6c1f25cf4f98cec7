#pragma once

#include <csignal>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/child_process.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi {

/// Runs a program to its end, which must be a good one.
inline void run_program(const std::vector<std::string>& command) {
  ChildProcess program(command);
  const std::string output = program.rest();
  if (program.wait() != 0) throw std::runtime_error(command[0] + " failed: " + output);
}

/// Debian's MQTT broker on the loopback, which a test can end, hold up and start again at the same port.
class MosquittoBroker {
 public:
  /// `more`: lines of its configuration that replace "let anybody in".
  explicit MosquittoBroker(std::string more = "allow_anonymous true\n")
      : port_(free_port(SOCK_STREAM)), more_(std::move(more)) {
    start();
  }

  std::uint16_t port() const { return port_; }

  void configure(std::string more) { more_ = std::move(more); }
  void start() {
    const auto file = folder_ / "mosquitto.conf";
    std::ofstream(file) << "listener " << port_ << " 127.0.0.1\n"
                        << "log_timestamp false\nuser root\npersistence false\n"
                        << more_;
    process_.emplace(std::vector<std::string>{"mosquitto", "-c", file.string()});
    process_->line_after("mosquitto version");
    process_->line_after("mosquitto version");  // starting, running
  }
  void stop() { process_.reset(); }
  /// It hangs: connections stay, and nothing is said on them.
  void hold() { process_->send(SIGSTOP); }
  void go_on() { process_->send(SIGCONT); }

  /// Publishes as any other program would; comes back when the broker has it.
  void publish(const std::string& topic, const std::string& payload, std::vector<std::string> more = {}) const {
    std::vector<std::string> command = {
        "mosquitto_pub", "-h", "127.0.0.1", "-p", std::to_string(port_), "-q", "1", "-t", topic, "-m", payload};
    command.insert(command.end(), more.begin(), more.end());
    run_program(command);
  }
  /// The same, kept for later subscribers, with a payload that is too long for a command line.
  void retain(const std::string& topic, const std::string& payload) const {
    const auto file = folder_ / "payload";
    std::ofstream(file) << payload;
    run_program({"mosquitto_pub", "-h", "127.0.0.1", "-p", std::to_string(port_), "-q", "1", "-r", "-t", topic, "-f",
                 file.string()});
  }

 private:
  test::TemporaryFolder folder_;
  std::uint16_t port_;
  std::string more_;
  std::optional<ChildProcess> process_;
};

}  // namespace yuragi
