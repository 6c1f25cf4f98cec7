#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "simulators/core/played_wind.hpp"
#include "simulators/core/simulator.hpp"

namespace yuragi::simulators::network {

struct OscOptions {
  std::string host = "127.0.0.1";  ///< whom it sends to
  std::uint16_t port = 9000;
  std::string address = "/wind";  ///< of the messages
  std::size_t speed_argument = 0;
  std::size_t direction_argument = 1;  ///< not that of the speed; arguments between them are 0
  double interval_s = 0.1;
  std::uint64_t seed = 1;  ///< of the bytes of the garbage fault
};

/// A program that sends the wind as Open Sound Control messages (OSC 1.0: address, type tags, big-endian arguments):
/// the speed in m/s and the direction in degrees, as 32-bit floats.
///
/// Faults: silence, freeze, spike, garbage, partial (the ends of messages are missing), wrong-id (of another address).
class OscSimulator final : public core::Simulator {
 public:
  /// Throws std::runtime_error for a host that is no address.
  OscSimulator(const OscOptions& options, core::MeasuredWind wind);
  ~OscSimulator() override;

  std::span<const core::FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override { return {}; }
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::simulators::network
