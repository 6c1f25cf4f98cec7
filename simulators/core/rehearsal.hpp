#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/platform/child_process.hpp"
#include "simulators/core/line_reader.hpp"
#include "simulators/core/scenario_file.hpp"
#include "simulators/core/simulator.hpp"

namespace yuragi::simulators::core {

/// The devices of a scenario, each a program of its own, all in the scenario's wind. What a device prints is printed
/// behind its name; a typed line "roof silence 5" goes to the device roof.
class Rehearsal final : public Simulator {
 public:
  /// Starts the devices: `program` is the simulators' program, `file` the one that the scenario was read from. Throws
  /// std::system_error.
  Rehearsal(const Scenario& scenario, const std::filesystem::path& program, const std::filesystem::path& file);
  ~Rehearsal() override;
  Rehearsal(const Rehearsal&) = delete;
  Rehearsal& operator=(const Rehearsal&) = delete;

  std::span<const FaultKind> known_faults() const override { return {}; }  // the devices have them
  std::vector<int> descriptors() const override;
  /// Throws std::runtime_error if a device has failed.
  void serve(std::span<const int> ready, double time_s, std::optional<FaultKind> fault) override;
  bool take_line(const std::string& line) override;
  std::string status() const override;
  bool is_over() const override { return devices_.empty(); }

 private:
  struct Device;

  std::unique_ptr<PlayedWind> wind_;
  PlayedMoment moment_;
  std::vector<std::unique_ptr<Device>> devices_;
};

}  // namespace yuragi::simulators::core
