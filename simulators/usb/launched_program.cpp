#include "simulators/usb/launched_program.hpp"

namespace yuragi::simulators::usb {
namespace {

constexpr int kPatience_ms = 2000;

}  // namespace

LaunchedProgram::LaunchedProgram(const std::vector<std::string>& command, core::Simulator& simulator)
    : simulator_(simulator), program_({.command = command, .patience_ms = kPatience_ms}) {}

std::vector<int> LaunchedProgram::descriptors() const {
  std::vector<int> all = simulator_.descriptors();
  all.push_back(program_.descriptor());
  return all;
}

void LaunchedProgram::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  if (const auto end = program_.end()) exit_code_ = end->shell_code();
  if (!exit_code_) simulator_.serve(ready, time_s, fault);
}

}  // namespace yuragi::simulators::usb
