#include "simulators/usb/launched_program.hpp"

namespace yuragi::simulators::usb {

LaunchedProgram::LaunchedProgram(const std::vector<std::string>& command, Simulator& simulator)
    : simulator_(simulator), program_(command, {}) {}

std::vector<int> LaunchedProgram::descriptors() const {
  std::vector<int> all = simulator_.descriptors();
  all.push_back(program_.descriptor());
  return all;
}

void LaunchedProgram::serve(std::span<const int> ready, double time_s, std::optional<FaultKind> fault) {
  exit_code_ = program_.exit_code();
  if (!exit_code_) simulator_.serve(ready, time_s, fault);
}

}  // namespace yuragi::simulators::usb
