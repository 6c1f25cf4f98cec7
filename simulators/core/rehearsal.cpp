#include "simulators/core/rehearsal.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/socket.h>

namespace yuragi::simulators::core {
namespace {

std::vector<std::string> command_of(const ScenarioDevice& device, const std::filesystem::path& program,
                                    const std::filesystem::path& file) {
  std::vector<std::string> command = {program.string()};
  for (std::string& word : CLI::detail::split_up(device.simulate)) command.push_back(CLI::detail::remove_quotes(word));
  command.insert(command.end(), {"--wind", file.string()});
  for (const std::string& fault : device.faults) command.insert(command.end(), {"--fault", fault});
  return command;
}

/// A pair of connected sockets: ours, and the one that becomes a child's standard input and output.
class SocketPair {
 public:
  SocketPair() {
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data()) != 0)
      throw std::system_error(errno, std::generic_category(), "socketpair");
  }
  ~SocketPair() {
    close(ours());
    close_theirs();
  }
  SocketPair(const SocketPair&) = delete;
  SocketPair& operator=(const SocketPair&) = delete;

  int ours() const { return ends_[0]; }
  int theirs() const { return ends_[1]; }
  /// After the start of the child, so that its end is the end of what we read.
  void close_theirs() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

}  // namespace

struct Rehearsal::Device {
  Device(std::string its_name, const std::vector<std::string>& command)
      : name(std::move(its_name)),
        program({.command = command,
                 .input = sockets.theirs(),
                 .output = sockets.theirs(),
                 .error = sockets.theirs(),
                 .patience_ms = 2000}),
        lines(sockets.ours()) {
    sockets.close_theirs();
  }

  std::string name;
  SocketPair sockets;
  platform::ChildProcess program;
  LineReader lines;
};

Rehearsal::Rehearsal(const Scenario& scenario, const std::filesystem::path& program, const std::filesystem::path& file)
    : wind_(play_phases(scenario.phases)) {
  for (const ScenarioDevice& device : scenario.devices)
    devices_.push_back(std::make_unique<Device>(device.name, command_of(device, program, file)));
}

Rehearsal::~Rehearsal() {
  for (const auto& device : devices_) device->program.signal(SIGTERM);  // all at once; each is then waited for
}

std::vector<int> Rehearsal::descriptors() const {
  std::vector<int> all;
  for (const auto& device : devices_) {
    if (device->lines.is_open()) all.push_back(device->lines.descriptor());
  }
  return all;
}

void Rehearsal::serve(std::span<const int> ready, double time_s, std::optional<FaultKind> /*fault*/) {
  moment_ = wind_->at(time_s);
  for (const auto& device : devices_) {
    if (std::ranges::find(ready, device->lines.descriptor()) == ready.end()) continue;
    device->lines.read_lines(
        [&](const std::string& line) { std::printf("%s: %s\n", device->name.c_str(), line.c_str()); });
  }
  std::fflush(stdout);

  // The last lines of a device are printed before its end is reported.
  std::erase_if(devices_, [](const auto& device) {
    const auto end = device->lines.is_open() ? std::nullopt : device->program.end();
    if (end && !end->is_good()) throw std::runtime_error(fmt::format("the device {} {}", device->name, text_of(*end)));
    return end.has_value();
  });
}

bool Rehearsal::take_line(const std::string& line) {
  const std::size_t blank = std::min(line.find(' '), line.size());
  const auto device =
      std::ranges::find(devices_, line.substr(0, blank), [](const auto& one) { return std::string_view(one->name); });
  if (device == devices_.end()) {
    std::fprintf(stderr, "allowed: DEVICE KIND [TIME], DEVICE clear or DEVICE help, with DEVICE one of");
    for (const auto& one : devices_) std::fprintf(stderr, " %s", one->name.c_str());
    std::fprintf(stderr, "\n");
    return true;
  }
  const std::string order = line.substr(std::min(blank + 1, line.size())) + "\n";
  // One that has ended takes no more orders: serve() finds it.
  (void)send((*device)->lines.descriptor(), order.data(), order.size(), MSG_NOSIGNAL);
  return true;
}

std::string Rehearsal::status() const {
  return fmt::format("wind {:.1f} m/s from {:.0f} degrees; {} devices", moment_.speed_m_s, moment_.direction_deg,
                     devices_.size());
}

}  // namespace yuragi::simulators::core
