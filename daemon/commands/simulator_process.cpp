#include "daemon/commands/simulator_process.hpp"

#include <array>
#include <chrono>

#include "daemon/tools/acceptance/simulated_sensor.hpp"
#include "daemon/tools/doctor/program_output.hpp"
#include "drivers/bus/process_port.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr auto kSimulatorStart = std::chrono::seconds(10);
constexpr std::size_t kMaxFirstLine = 4096;

}  // namespace

Result<SimulatorProcess, Failure> SimulatorProcess::start(const std::vector<std::string>& arguments) {
  const auto program = tools::doctor::find_program("yuragi-sim");
  if (!program) return Failure{"yuragi-sim is not installed", FailureKind::kUnavailable};
  std::vector<std::string> command = {*program};
  command.insert(command.end(), arguments.begin(), arguments.end());
  auto process = drivers::bus::make_process_port(std::move(command));
  if (const auto opened = process->open(); !opened) return opened.error();

  std::string output;
  std::array<std::uint8_t, 512> buffer{};
  const auto deadline = std::chrono::steady_clock::now() + kSimulatorStart;
  while (output.size() < kMaxFirstLine) {
    const Nanoseconds left = deadline - std::chrono::steady_clock::now();
    if (left <= Nanoseconds{0}) break;
    const auto arrival = process->read(buffer, left);
    if (arrival.status == drivers::bus::ByteStatus::kSilence) continue;
    if (arrival.status != drivers::bus::ByteStatus::kBytes) break;
    output.append(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(arrival.size));
    if (const auto port = tools::acceptance::simulator_port(output)) return SimulatorProcess(std::move(process), *port);
  }
  return Failure{"yuragi-sim cannot simulate it: its message is on standard error", FailureKind::kUnavailable};
}

}  // namespace yuragi::daemon::commands
