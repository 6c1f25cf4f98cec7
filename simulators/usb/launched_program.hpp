#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/platform/child_process.hpp"
#include "simulators/core/simulator.hpp"

namespace yuragi::simulators::usb {

/// A program that runs in the simulator's testbed; when it ends, the simulation ends. Its standard input is empty,
/// since the simulator's own takes commands.
class LaunchedProgram final : public core::Simulator {
 public:
  /// Starts it; `simulator` must outlive this. Throws std::system_error.
  LaunchedProgram(const std::vector<std::string>& command, core::Simulator& simulator);

  /// As a shell reports it; nullopt: it is still running.
  std::optional<int> exit_code() const noexcept { return exit_code_; }

  std::span<const core::FaultKind> known_faults() const override { return simulator_.known_faults(); }
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override { return simulator_.status(); }
  bool is_over() const override { return exit_code_.has_value(); }

 private:
  core::Simulator& simulator_;
  platform::ChildProcess program_;
  std::optional<int> exit_code_;
};

}  // namespace yuragi::simulators::usb
